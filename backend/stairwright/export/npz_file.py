"""NPZ: arrays named as in the contract, and everything else as JSON text in ``metadata``."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot.description import JOINTS, PLANAR_JOINTS
from stairwright.simulation.result import Rollout

from .columns import FRAMES, UNITS, plan_arrays, rollout_arrays

MAX_UNPACKED = 512 * 2**20  # bytes; a small file must not unpack into a full memory
_MARGINS = ("clearance", "com", "friction", "torque")


def plan_npz(plan: Plan) -> bytes:
    """Arrays of the poses, ``critical`` indices, and the rest of the plan as metadata."""
    arrays: dict[str, NDArray[Any]] = dict(plan_arrays(plan))
    arrays["critical"] = np.array(plan.critical, dtype=np.int64)
    if plan.poses and all(pose.forces is not None for pose in plan.poses):
        arrays["forces"] = np.array([pose.forces for pose in plan.poses], float)
    rest = plan.model_dump(mode="json", exclude={"poses", "critical"})
    return _pack(arrays, rest, list(PLANAR_JOINTS))


def rollout_npz(rollout: Rollout) -> bytes:
    """The series, and the rest of the rollout (its plan without poses) as metadata."""
    rest = rollout.model_dump(mode="json", exclude={"series": True, "plan": True})
    return _pack(dict(rollout_arrays(rollout)), rest, list(JOINTS))


def load_npz(path: Path) -> dict[str, Any]:
    """The document that an NPZ file of ours holds, as plain data.

    Raises:
        InputError: If it is none of ours, or damaged.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > MAX_UNPACKED:
                raise InputError(f"{path} unpacks to more than {MAX_UNPACKED >> 20} MiB")
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        metadata = json.loads(str(arrays.pop("metadata")))["document"]
    except InputError:
        raise
    except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
        raise InputError(f"{path} is not an NPZ file of Stairwright: {error}") from None
    try:
        if metadata["schema"] == "stairwright/plan/1":
            return {**metadata, **_poses(arrays)}
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise InputError(f"{path} lacks arrays of a plan: {error}") from None
    return {**metadata, "series": {name: values.tolist() for name, values in arrays.items()}}


def _poses(arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
    listed = {name: values.tolist() for name, values in arrays.items()}
    poses = [
        {
            "progress": listed["progress"][i],
            "time": listed["time"][i],
            **dict(zip(("x_c", "z_c", "pitch"), listed["trunk"][i], strict=True)),
            **{
                name: listed[name][i]
                for name in ("q", "wheels", "wheel_progress", "contacts", "com", "collision_points")
            },
            "forces": listed["forces"][i] if "forces" in listed else None,
            "margins": dict(zip(_MARGINS, listed["margins"][i], strict=True)),
        }
        for i in range(len(listed["progress"]))
    ]
    return {"poses": poses, "critical": listed["critical"]}


def _pack(arrays: dict[str, NDArray[Any]], document: dict[str, Any], joints: list[str]) -> bytes:
    about = {"document": document, "units": UNITS, "frames": FRAMES, "joint_order": joints}
    out = io.BytesIO()
    np.savez_compressed(out, metadata=np.array(json.dumps(about)), **arrays)  # type: ignore[arg-type]
    return out.getvalue()
