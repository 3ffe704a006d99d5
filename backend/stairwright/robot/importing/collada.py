"""Corners of a COLLADA (.dae) mesh, which makers of URDF like and MuJoCo does not read.

Only places are read, in the file's unit of length; shapes collide as their convex hulls anyway. As
in ROS, <up_axis> has no effect.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError

from .xml import parse

_MOST_BYTES = 32 * 2**20
_DEEPEST = 30  # nodes in nodes


def corners(content: bytes, name: str) -> Floats | None:
    """(n, 3) all corners in the scene [m]; None if there is none.

    Raises:
        InputError: If it is no XML or unfit to be read.
    """
    root = parse(content, name, most=_MOST_BYTES)
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
    try:
        meshes = {f"#{each.get('id')}": _places(each) for each in root.iter("geometry")}
        found: list[Floats] = []
        for scene in root.iter("visual_scene"):
            for node in scene.findall("node"):
                _gather(node, np.eye(4), meshes, found, 0)
        points = np.concatenate(found or list(meshes.values()))
        unit = root.find("asset/unit")
        scale = 1.0 if unit is None else float(unit.get("meter", "1"))
    except (ValueError, IndexError, TypeError) as error:
        raise InputError(f"{name} is no COLLADA file: {error}", ("file",)) from None
    return points * scale if len(points) else None


def _places(geometry: ET.Element) -> Floats:
    """(n, 3) what <vertices> of a geometry refer to."""
    sources = {f"#{each.get('id')}": each for each in geometry.iter("source")}
    found = [np.zeros((0, 3))]
    for given in geometry.iterfind("mesh/vertices/input"):
        source = sources.get(given.get("source", ""))
        if given.get("semantic") != "POSITION" or source is None:
            continue
        accessor = source.find("technique_common/accessor")
        stride = 3 if accessor is None else int(accessor.get("stride", "3"))
        values = np.array((source.findtext("float_array") or "").split(), np.float64)
        found.append(values.reshape(-1, stride)[:, :3])
    return np.concatenate(found)


def _gather(
    node: ET.Element, above: Floats, meshes: dict[str, Floats], found: list[Floats], depth: int
) -> None:
    """Corners of a node and of those in it, in the scene's frame."""
    if depth > _DEEPEST:
        return
    own = above
    for step in node:
        own = own @ _transform(step)
    for use in node.findall("instance_geometry"):
        points = meshes.get(use.get("url", ""))
        if points is not None:
            found.append(points @ own[:3, :3].T + own[:3, 3])
    for child in node.findall("node"):
        _gather(child, own, meshes, found, depth + 1)


def _transform(step: ET.Element) -> Floats:
    """(4, 4) of one element of a node; of others the identity."""
    made = np.eye(4)
    if step.tag not in ("matrix", "translate", "rotate", "scale"):
        return made
    values = np.array((step.text or "").split(), np.float64)
    if step.tag == "matrix":
        return values.reshape(4, 4)
    if step.tag == "translate":
        made[:3, 3] = values[:3]
    elif step.tag == "scale":
        made[:3, :3] = np.diag(values[:3])
    else:
        axis, angle = values[:3] / np.linalg.norm(values[:3]), math.radians(float(values[3]))
        cross = np.array([(0, -axis[2], axis[1]), (axis[2], 0, -axis[0]), (-axis[1], axis[0], 0)])
        made[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return made
