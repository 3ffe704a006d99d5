"""A bundle: what a robot's computer needs to carry out a plan, in one zip.

The plan as the player reads it, the plan's document, the robot's URDF, and the sources of the
player, which need a C++20 compiler and CMake and nothing else.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from pathlib import Path
from string import Template

from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.resources import data_folder

from .json_file import document_json
from .player_plan import player_plan
from .urdf_file import plan_urdf

_README = Path(__file__).with_name("bundle_readme.md")
_SOURCES = ("CMakeLists.txt", "include", "src", "player", "ros2")
# Simulator and planner.
_STAY_HERE = ("rollout", "lattice", "poses", "smoothing", "timing", "certificate")
_DATE = (2000, 1, 1, 0, 0, 0)  # the same plan is the same file


def plan_bundle(plan: Plan) -> bytes:
    """The whole zip.

    Raises:
        InputError: If the plan is infeasible.
    """
    course = player_plan(plan).encode()
    files = {
        "README.md": _readme(plan).encode(),
        "plan.txt": course,
        "plan.json": document_json(plan),
        "robot.urdf": plan_urdf(plan),
        **dict(_sources(data_folder("native"))),
    }
    top = f"stairwright-{plan.robot}"
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(f"{top}/{name}", _DATE)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def _sources(folder: Path) -> Iterator[tuple[str, bytes]]:
    if not (folder / "CMakeLists.txt").is_file():
        raise InputError("the player's sources are not installed here", ("format",))
    for name in _SOURCES:
        place = folder / name
        for path in [place] if place.is_file() else sorted(place.rglob("*")):
            if path.is_file() and path.parent.name not in _STAY_HERE:
                yield f"native/{path.relative_to(folder).as_posix()}", path.read_bytes()


def _readme(plan: Plan) -> str:
    start, end = plan.poses[0], plan.poses[-1]
    vertices = plan.terrain.vertices
    front = start.wheels[0][0]
    return Template(_README.read_text(encoding="utf-8")).substitute(
        robot=plan.robot,
        terrain=plan.terrain.name or "a drawn terrain",
        plan=plan.id,
        friction=f"{plan.friction:g}",
        front=f"{front:.3f}",
        ahead=f"{vertices[1][0] - front:.3f}",
        edge=f"{vertices[1][0]:.3f}",
        joints=", ".join(f"{q:.2f}" for q in start.q),
        length=f"{end.x_c - start.x_c:.2f}",
    )
