"""What was sent: one XML file, or a zip that holds it with its meshes. All of it in memory."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from stairwright.complaints import described, schema_in
from stairwright.errors import InputError

MOST_BYTES = 64 * 2**20  # of everything, unpacked
MOST_XML = 4 * 2**20
_MOST_FILES = 2000
XML_ENDINGS = (".urdf", ".xml", ".mjcf")
XACRO = "this is xacro, not yet URDF: run xacro on it first"
_MESHES = (".stl", ".obj", ".msh", ".dae", ".ply", ".off")


@dataclass(frozen=True)
class Upload:
    """A robot file and its companions.

    Attributes:
        name: Of the robot file, with folders inside the zip.
        content: The robot file.
        files: Everything else, by path inside the zip.
    """

    name: str
    content: bytes
    files: Mapping[str, bytes] = field(default_factory=dict)

    def find(self, reference: str) -> str | None:
        """The path of the file that `reference` means; None if it was not sent.

        A reference may start with a package's name or a folder that was not packed: the file
        that shares the most of its end with the reference is meant. None ever lies outside.
        """
        _, _, path = reference.replace("\\", "/").rpartition("://")
        wanted = [part.lower() for part in path.split("/") if part not in ("", ".", "..")]
        best, shared = None, 0
        for name in self.files:
            have = [part.lower() for part in PurePosixPath(name).parts]
            count = 0
            while count < min(len(have), len(wanted)) and have[-1 - count] == wanted[-1 - count]:
                count += 1
            if count > shared:
                best, shared = name, count
        return best


def unpack(data: bytes, file_name: str) -> Upload:
    """The robot file in `data`, which is one itself or a zip.

    Raises:
        InputError: If there is no robot file, or more than one could be it.
    """
    if data[:4] != b"PK\x03\x04":
        _check_ending(file_name, data)
        return Upload(PurePosixPath(file_name).name, data)
    files = _entries(data)
    names = [name for name in files if name.lower().endswith(XML_ENDINGS)]
    roots = [name for name in names if _is_robot(files[name])]
    if not roots:
        raise InputError("the zip holds no URDF or MJCF file", ("file",))
    chosen = _main(roots, files)
    rest = {name: content for name, content in files.items() if name != chosen}
    return Upload(chosen, files[chosen], rest)


def _check_ending(file_name: str, data: bytes) -> None:
    if file_name.lower().endswith(".zip"):
        raise InputError(f"{PurePosixPath(file_name).name!r} is not a zip", ("file",))
    if file_name.lower().endswith(".xacro"):
        raise InputError(XACRO, ("file",))
    if not file_name.lower().endswith(XML_ENDINGS):
        name = PurePosixPath(file_name).name or "the file"
        schema = schema_in(data)
        raise InputError(
            f"{name!r} is {described(schema)}, not a URDF, MJCF or zip"
            if schema
            else f"{name!r} must end with {', '.join(XML_ENDINGS)} or .zip",
            ("file",),
        )


def _entries(data: bytes) -> dict[str, bytes]:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = [each for each in archive.infolist() if not each.is_dir()]
            if len(entries) > _MOST_FILES:
                raise InputError(f"the zip holds more than {_MOST_FILES} files", ("file",))
            if sum(each.file_size for each in entries) > MOST_BYTES:
                raise InputError(f"unpacks to more than {MOST_BYTES >> 20} MiB", ("file",))
            return _unpacked(archive, entries)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError) as error:
        raise InputError(f"the zip cannot be read: {error}", ("file",)) from None


def _unpacked(archive: zipfile.ZipFile, entries: list[zipfile.ZipInfo]) -> dict[str, bytes]:
    """Only what may be of use; sizes in a zip's directory may lie, so reading stops there."""
    files = {}
    for entry in entries:
        path = PurePosixPath(entry.filename.replace("\\", "/"))
        if path.is_absolute() or ".." in path.parts:
            raise InputError(f"the zip names a file outside itself: {entry.filename!r}", ("file",))
        if path.suffix.lower() not in (*XML_ENDINGS, *_MESHES):
            continue
        with archive.open(entry) as stream:
            content = stream.read(entry.file_size + 1)
        if len(content) > entry.file_size:
            raise InputError(f"{entry.filename!r} is larger than the zip says", ("file",))
        files[str(path)] = content
    return files


def _is_robot(content: bytes) -> bool:
    head = content[: 2**16]
    return b"<robot" in head or (b"<mujoco" in head and b"<worldbody" in content)


def _main(roots: list[str], files: Mapping[str, bytes]) -> str:
    """The robot file among several: one that no other includes, with four wheels' worth of parts.

    Scenes include the robot, and are taken before it only if nothing else is there.
    """
    included = [
        name
        for name in roots
        if any(
            PurePosixPath(name).name.encode() in files[other] for other in roots if other != name
        )
    ]
    tops = [name for name in roots if b"<include" not in files[name]] or roots
    if len(tops) == 1:
        return tops[0]
    only = [name for name in tops if name in included]
    if len(only) == 1:
        return only[0]
    shown = ", ".join(sorted(tops)[:6])
    raise InputError(f"the zip holds several robot files, send one: {shown}", ("file",))
