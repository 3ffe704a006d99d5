"""Results as files named by their content: written once, never changed, never half there."""

from __future__ import annotations

import gzip
import hashlib
import os
import tempfile
import time
from pathlib import Path

_PARTIAL = ".partial"
_ABANDONED = 3600.0  # s; a partial file this old belongs to a process that has died


class Artefacts:
    """Gzipped JSON documents in a folder, by the SHA-256 of their uncompressed content."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def path(self, digest: str) -> Path:
        """Where the artefact lies or would lie."""
        return self.folder / digest[:2] / f"{digest}.json.gz"

    def put(self, content: bytes) -> tuple[str, bytes]:
        """Keep `content`; returns its digest and the compressed bytes.

        A reader sees the whole file or none: it is renamed into place when complete.
        """
        digest = hashlib.sha256(content).hexdigest()
        packed = gzip.compress(content, compresslevel=3, mtime=0)
        target = self.path(digest)
        try:
            os.utime(target)  # young again: a sweep that runs right now must not take it
        except FileNotFoundError:
            target.parent.mkdir(exist_ok=True)
            handle, partial = tempfile.mkstemp(suffix=_PARTIAL, dir=target.parent)
            try:
                with os.fdopen(handle, "wb") as file:
                    file.write(packed)
                    file.flush()
                    os.fsync(file.fileno())
                Path(partial).replace(target)
            except BaseException:
                Path(partial).unlink(missing_ok=True)
                raise
        return digest, packed

    def packed(self, digest: str) -> bytes:
        """The compressed bytes.

        Raises:
            FileNotFoundError: If it is not there (any more).
        """
        return self.path(digest).read_bytes()

    def content(self, digest: str) -> bytes:
        """The document's JSON.

        Raises:
            FileNotFoundError: If it is not there (any more).
        """
        return gzip.decompress(self.packed(digest))

    def remove(self, digest: str) -> None:
        """Forget it; nothing happens if it is not there."""
        self.path(digest).unlink(missing_ok=True)

    def sweep(self, wanted: set[str], grace: float = _ABANDONED) -> int:
        """Remove files that nobody refers to and that are older than `grace` [s]; how many."""
        before, removed = time.time() - grace, 0
        for path in self.folder.glob("??/*"):
            digest = path.name.removesuffix(".json.gz")
            try:
                if digest not in wanted and path.stat().st_mtime < before:
                    path.unlink()
                    removed += 1
            except FileNotFoundError:
                continue  # another process was faster
        return removed
