"""The terrain in MuJoCo: its profile extruded along y, as convex prisms."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from stairwright.arrays import Floats
from stairwright.terrain.profile import Terrain

GROUND = 1  # collision bit: contype of the terrain, conaffinity of all that touches it
TERRAIN_HALF_WIDTH = 1.0  # m
TERRAIN_DEPTH = 0.5  # m below the lowest point
RUN_OUT = 1.0  # m of level ground beyond either end
SPIKE_WIDTH = 0.002  # m; a zero-width spike becomes a prism this thick
_VERTICAL = 1e-6  # m; a face that advances less than this is vertical
_COLOUR = (0.62, 0.65, 0.70, 1.0)


def prisms(terrain: Terrain) -> list[Floats]:
    """Convex outlines (k, 2) of the ground: one under each stretch, thin ones for spikes.

    The ground goes on level beyond its ends: a robot that is not quite where it believes rolls on.
    """
    run_out = np.array([RUN_OUT, 0.0])
    p = np.vstack([terrain.vertices[0] - run_out, terrain.vertices, terrain.vertices[-1] + run_out])
    floor = float(p[:, 1].min()) - TERRAIN_DEPTH
    outlines = []
    for i in range(len(p) - 1):
        (x0, z0), (x1, z1) = p[i], p[i + 1]
        if x1 - x0 > _VERTICAL:
            outlines.append(np.array([(x0, floor), (x1, floor), (x1, z1), (x0, z0)]))
        elif i + 2 < len(p) and z1 > z0 and p[i + 2, 0] - x1 <= _VERTICAL and p[i + 2, 1] < z1:
            a, b = x1 - SPIKE_WIDTH / 2, x1 + SPIKE_WIDTH / 2
            outlines.append(np.array([(a, floor), (b, floor), (b, z1), (a, z1)]))
    return outlines


def add_terrain(spec: Any, terrain: Terrain, friction: float, half_width: float) -> None:
    """Add the terrain's prisms to the world: boxes where the top is level, meshes elsewhere."""
    for i, outline in enumerate(prisms(terrain)):
        shape: dict[str, Any]
        (x0, floor), (x1, _), (_, z1), (_, z0) = outline
        if z0 == z1:
            shape = {
                "type": mujoco.mjtGeom.mjGEOM_BOX,
                "size": [(x1 - x0) / 2, half_width, (z0 - floor) / 2],
                "pos": [(x0 + x1) / 2, 0.0, (z0 + floor) / 2],
            }
        else:
            mesh = spec.add_mesh(name=f"terrain_{i}")
            corners = [(x, y, z) for y in (-half_width, half_width) for x, z in outline]
            mesh.uservert = np.array(corners).ravel()
            shape = {"type": mujoco.mjtGeom.mjGEOM_MESH, "meshname": mesh.name}
        spec.worldbody.add_geom(
            name=f"terrain_{i}",
            contype=GROUND,
            conaffinity=0,
            priority=1,  # the terrain's friction holds, whatever touches it
            condim=3,
            friction=[friction, 0.0, 0.0],
            rgba=_COLOUR,
            **shape,
        )
