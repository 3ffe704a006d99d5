"""Results as files named by their content: written once, never changed, never half there.

A document is written plainly first, which takes a fraction of a millisecond, so that an answer can
wait for it; `settle` compresses it and forces it to the disk when nobody waits any more. A plain
file survives whatever kills this process. Power cuts and worn-out disks damage files, so content
is checked against its name whenever it is read, and a file that does not fit counts as missing.
"""

from __future__ import annotations

import contextlib
import errno
import gzip
import hashlib
import logging
import os
import threading
import time
import zlib
from pathlib import Path

logger = logging.getLogger(__name__)

_PLAIN, _PACKED, _PARTIAL = ".json", ".json.gz", ".partial"
_LEVEL = 1  # of gzip: level 4 takes three times as long for 5 % less
_ABANDONED = 1800.0  # s after which what nobody refers to belongs to a process that has died


class Artefacts:
    """JSON documents in a folder, by the SHA-256 of their content."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        with contextlib.suppress(OSError):  # what is put will say what is wrong
            folder.mkdir(parents=True, exist_ok=True)
        self._orphans: dict[tuple[Path, int], float] = {}  # since when they are known as such

    def path(self, digest: str) -> Path:
        """Where the settled artefact lies or would lie."""
        return self.folder / digest[:2] / f"{digest}{_PACKED}"

    def _plain(self, digest: str) -> Path:
        return self.folder / digest[:2] / f"{digest}{_PLAIN}"

    def has(self, digest: str) -> bool:
        """Whether it is there, settled or not, perhaps damaged."""
        return self.path(digest).is_file() or self._plain(digest).is_file()

    def intact(self, digest: str) -> bool:
        """Whether it can be read and is what was put."""
        try:
            self.packed(digest)
        except FileNotFoundError:
            return False
        return True

    def put(self, content: bytes) -> str:
        """Keep `content`; returns its digest. It still has to be settled.

        A reader sees the whole file or none: it is renamed into place when complete.
        """
        digest = name_of(content)
        if self._settled(digest) is None:
            _write(self._plain(digest), content, durable=False)
        else:
            os.utime(self.path(digest))  # young again: a sweep that runs now must not take it
        return digest

    def settle(self, digest: str) -> int | None:
        """Compress what was put, for good; returns its size on disk [bytes].

        None if there is nothing (any more). Doing it twice does no harm.
        """
        plain, target = self._plain(digest), self.path(digest)
        with contextlib.suppress(FileNotFoundError):
            if self._settled(digest) is None:
                _write(target, _pack(_checked(plain, digest)), durable=True)
            plain.unlink(missing_ok=True)
            return target.stat().st_size
        return None

    def unsettled(self) -> list[str]:
        """Digests of what was put and not settled, by this process or one that has died."""
        return [path.stem for path in self.folder.glob(f"??/*{_PLAIN}")]

    def packed(self, digest: str) -> bytes:
        """The document's JSON, gzipped.

        Raises:
            FileNotFoundError: If it is not there (any more).
        """
        packed = self._settled(digest)
        if packed is not None:
            return packed
        try:
            return _pack(_checked(self._plain(digest), digest))
        except FileNotFoundError:
            packed = self._settled(digest)  # settled between the two looks
            if packed is None:
                raise
            return packed

    def _settled(self, digest: str) -> bytes | None:
        """The settled file as it lies; None if there is none or it does not fit its name."""
        path = self.path(digest)
        try:
            packed = path.read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            if error.errno != errno.EIO:  # a place on the disk that cannot be read
                raise
        else:
            if _fits(packed, digest):
                return packed
        _discard(path)
        return None

    def content(self, digest: str) -> bytes:
        """The document's JSON.

        Raises:
            FileNotFoundError: If it is not there (any more).
        """
        return gzip.decompress(self.packed(digest))

    def remove(self, digest: str) -> None:
        """Forget it; nothing happens if it is not there."""
        self.path(digest).unlink(missing_ok=True)
        self._plain(digest).unlink(missing_ok=True)

    def sweep(self, wanted: set[str], grace: float = _ABANDONED) -> int:
        """Remove files that nobody refers to, now and at a sweep `grace` [s] ago; how many.

        Their own times do not count: they come from a clock that may have been wrong.
        """
        now, removed = time.monotonic(), 0
        known, self._orphans = self._orphans, {}
        for path in self.folder.glob("??/*"):
            digest = path.name.removesuffix(_PACKED).removesuffix(_PLAIN)
            try:
                if digest in wanted:
                    continue
                version = (path, path.stat().st_mtime_ns)  # another one once it was put again
                since = known.get(version, now)
                if now - since < grace:
                    self._orphans[version] = since
                else:
                    path.unlink()
                    removed += 1
            except FileNotFoundError:
                continue  # another process was faster
        return removed


def name_of(content: bytes) -> str:
    """The name of a content: its digest."""
    return hashlib.sha256(content).hexdigest()


def _pack(content: bytes) -> bytes:
    return gzip.compress(content, compresslevel=_LEVEL, mtime=0)


def _fits(packed: bytes, digest: str) -> bool:
    try:
        content = gzip.decompress(packed)
    except (OSError, EOFError, zlib.error):
        return False
    return name_of(content) == digest


def _checked(path: Path, digest: str) -> bytes:
    """The file's content; one that was cut short by a power cut is removed and missing."""
    content = path.read_bytes()
    if name_of(content) != digest:
        _discard(path)
        raise FileNotFoundError(path)
    return content


def _discard(path: Path) -> None:
    logger.error("%s is damaged; it counts as missing and is made anew when asked for", path)
    with contextlib.suppress(OSError):  # a disk that cannot be written: it will not fit next time
        path.unlink(missing_ok=True)


def _write(target: Path, content: bytes, *, durable: bool) -> None:
    partial = f"{target}.{os.getpid()}-{threading.get_ident()}{_PARTIAL}"
    try:
        try:
            file = open(partial, "wb")  # noqa: PTH123, SIM115 - somebody waits for this
        except FileNotFoundError:
            target.parent.mkdir(exist_ok=True)
            file = open(partial, "wb")  # noqa: PTH123, SIM115
        with file:
            file.write(content)
            if durable:
                file.flush()
                os.fsync(file.fileno())
        os.replace(partial, target)  # noqa: PTH105
    except BaseException:
        Path(partial).unlink(missing_ok=True)
        raise
