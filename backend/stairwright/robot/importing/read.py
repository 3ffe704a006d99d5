"""Read a robot file in this process; see `bounded` for one with limits."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Any

from stairwright.robot.description import Robot

from .assemble import Reading, assemble
from .own import OWN_ENDINGS, read_own
from .report import Imported, Notes
from .source import compile_source
from .traps import note_traps
from .upload import Upload, unpack
from .verify import verify


def read(upload: Upload, options: Mapping[str, Any], known: Sequence[Robot] = ()) -> Imported:
    """The robot in an upload.

    Args:
        upload: The file and its meshes.
        options: ``abduction`` [rad], ``wheel_radius`` [m] and ``hold`` (joints that are rigid, by
            the file's names [rad or m]), all optional.
        known: Robots whose numbers fill gaps where the legs are the same.

    Raises:
        InputError: If it is none, or not one of four legs with a thigh, a calf and a wheel each.
    """
    reading, notes = read_closely(upload, options, known)
    robot, source = reading.robot, reading.source
    return Imported(
        robot=robot,
        assumed=list(robot.assumed),
        warnings=notes.warnings,
        joints=reading.joints,
        locked={source.joint(joint): at for joint, at in reading.held.items()},
    )


def read_closely(
    upload: Upload, options: Mapping[str, Any], known: Sequence[Robot] = ()
) -> tuple[Reading, Notes]:
    """The robot together with MuJoCo's model of its file, and the remarks."""
    notes = Notes()
    source = compile_source(upload, notes)
    digest = hashlib.sha256(upload.content).hexdigest()[:16]
    origin = f"{PurePosixPath(upload.name).name} ({source.kind.upper()}, sha256 {digest})"
    reading = assemble(
        source,
        notes,
        abduction=float(options.get("abduction") or 0.0),
        wheel_radius=options.get("wheel_radius"),
        hold=options.get("hold") or {},
        known=known,
        origin=origin,
    )
    verify(reading, notes)
    note_traps(reading.robot, known, notes)
    return reading, notes


def read_file(
    data: bytes,
    file_name: str,
    options: Mapping[str, Any],
    known: Sequence[Robot] = (),
    files: Mapping[str, bytes] | None = None,
) -> Imported:
    """The robot in a file of another tool's, or of ours; `files` are those beside it, if any."""
    suffix = PurePosixPath(file_name).suffix.lower()
    if suffix in OWN_ENDINGS:
        return read_own(data, suffix, options)
    upload = unpack(data, file_name)
    return read(replace(upload, files=files) if files else upload, options, known)
