"""A robot file on this machine, and the meshes in its folder that it names."""

from __future__ import annotations

import os
import re
from pathlib import Path, PurePosixPath

from stairwright.errors import InputError

from .upload import MOST_BYTES, MOST_XML, XML_ENDINGS

_REFERENCE = re.compile(rb"""(?:file|filename)\s*=\s*["']([^"'<>]{1,500})["']""")
_MOST_FILES = 2000
_MOST_FOLDERS = 300


def gather(path: str | os.PathLike[str]) -> tuple[str, bytes, dict[str, bytes]]:
    """A file's name, its content, and what it names inside its own folder, by relative path.

    Nothing outside that folder is read: a file whose meshes lie elsewhere is sent as a zip.

    Raises:
        InputError: If the file cannot be read or is too large.
    """
    file = Path(path)
    try:
        if file.stat().st_size > MOST_BYTES:
            raise InputError(f"{file} is larger than {MOST_BYTES >> 20} MiB", ("file",))
        content = file.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {file}: {error.strerror or error}", ("file",)) from None
    except ValueError as error:  # a name that no file can have
        raise InputError(f"cannot read {str(file)!r}: {error}", ("file",)) from None
    if content[:4] == b"PK\x03\x04" or len(content) > MOST_XML:
        return file.name, content, {}
    return file.name, content, _companions(file.resolve(), content)


def _companions(file: Path, content: bytes) -> dict[str, bytes]:
    """Files below the folder of `file` whose name it, or what it includes, mentions."""
    folder = file.parent
    wanted: set[str] = set()
    queue = [content]
    found: dict[str, bytes] = {}
    places = _places(folder) if _REFERENCE.search(content) else {}
    room = MOST_BYTES - len(content)
    while queue and len(wanted) < _MOST_FILES:
        for reference in _REFERENCE.findall(queue.pop()):
            name = PurePosixPath(reference.decode("utf-8", "replace").replace("\\", "/")).name
            if name.lower() in wanted:
                continue
            wanted.add(name.lower())
            for place in places.get(name.lower(), []):
                data = _read(place, room)
                if data is None or place == file:
                    continue
                room -= len(data)
                found[place.relative_to(folder).as_posix()] = data
                if name.lower().endswith(XML_ENDINGS):
                    queue.append(data)
    return found


def _places(folder: Path) -> dict[str, list[Path]]:
    """Regular files below a folder by their names in lower case; links are not followed."""
    found: dict[str, list[Path]] = {}
    for count, (place, _, names) in enumerate(os.walk(folder, followlinks=False)):
        if count >= _MOST_FOLDERS:
            break
        for name in names:
            path = Path(place, name)
            if not path.is_symlink():
                found.setdefault(name.lower(), []).append(path)
    return found


def _read(path: Path, room: int) -> bytes | None:
    try:
        return path.read_bytes() if path.is_file() and path.stat().st_size <= room else None
    except OSError:
        return None
