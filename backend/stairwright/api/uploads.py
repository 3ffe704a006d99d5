"""Files that are sent: read in the sealed worker, one at a time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePath
from typing import Any

from fastapi import UploadFile

from stairwright.errors import InputError
from stairwright.jobs.failures import DeadlineExceeded, WorkerDied

from .services import Services

DEADLINE = 20.0  # s


async def read_upload(
    services: Services, reader: Callable[..., dict[str, Any]], file: UploadFile, *arguments: Any
) -> dict[str, Any]:
    """What `reader(content, name, *arguments)` finds in a file.

    Raises:
        InputError: If it cannot be read, or not with the time and memory that there are for it.
    """
    name, content = PurePath(file.filename or "").name, await file.read()
    try:
        async with services.uploading:
            document: dict[str, Any] = await services.upload_pool.run(
                reader, content, name, *arguments, deadline=DEADLINE
            )
            return document
    except (DeadlineExceeded, WorkerDied, MemoryError):
        raise InputError("takes too much time or memory to read", ("file",)) from None
