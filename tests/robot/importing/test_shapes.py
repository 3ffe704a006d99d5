"""Outlines and capsules hold everything that the file's shapes reach, and little more."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import LineString, MultiPoint, Point, Polygon
from shapely.ops import unary_union

from stairwright.robot.importing.capsules import around, limited
from stairwright.robot.importing.outline import area, covers, hull, outer
from stairwright.robot.importing.read import read_closely
from stairwright.robot.importing.upload import Upload
from tests.robot.importing.files import Design, scrambled
from tests.robot.importing.written import mjcf

points = st.lists(
    st.tuples(st.floats(-1, 1, allow_nan=False), st.floats(-1, 1, allow_nan=False)),
    min_size=3, max_size=60,
).map(np.array)  # fmt: skip


@given(points)
def test_a_polygon_of_few_corners_lies_outside(cloud: np.ndarray) -> None:
    polygon = outer(cloud, 8)
    assert 3 <= len(polygon) <= 8
    assert area(polygon) > 0
    assert covers(polygon, cloud)
    assert Polygon(polygon).buffer(1e-6).covers(MultiPoint(cloud))


def test_sixteen_corners_round_a_circle_add_little() -> None:
    angle = np.linspace(0, 2 * math.pi, 200)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    assert area(outer(circle)) < 1.025 * math.pi


@given(points)
def test_a_capsule_holds_all_points(cloud: np.ndarray) -> None:
    capsule = around(cloud)
    line = LineString([capsule.start, capsule.end])
    assert max(line.distance(Point(p)) for p in cloud) <= capsule.radius + 1e-6
    width = max(float(np.ptp(cloud[:, 0])), float(np.ptp(cloud[:, 1])), 1e-3)
    assert capsule.radius <= 1.5 * width  # no wider than the cloud is long


@pytest.mark.slow
@given(st.lists(points, min_size=3, max_size=6))
def test_what_is_one_capsule_too_many_is_held_by_another(clouds: list[np.ndarray]) -> None:
    capsules = [around(cloud) for cloud in clouds]
    kept = limited(capsules, 2)
    assert len(kept) == 2
    held = unary_union([LineString([c.start, c.end]).buffer(c.radius + 1e-6, 128) for c in kept])
    for cloud in clouds:
        assert held.buffer(1e-3).covers(MultiPoint(hull(cloud)))


@pytest.mark.parametrize("seed", range(4))
def test_the_robot_holds_the_files_shapes(seed: int) -> None:
    """Points of MuJoCo's own shapes, on their surfaces, lie in the robot's side view."""
    design = scrambled(seed) if seed else Design()
    reading, _ = read_closely(Upload("a.xml", mjcf(design).encode()), {})
    source, robot = reading.source, reading.robot
    trunk = unary_union([Polygon(piece.points) for piece in robot.body.outline])
    links = {}
    for name, leg in zip(("F", "R"), robot.legs, strict=True):
        foot = Point(0.0, -leg.calf.length).buffer(leg.wheel.radius + 1e-9, 256)
        for k, form in enumerate((leg.thigh, leg.calf)):
            shapes = [LineString([a, b]).buffer(r + 1e-9, 64) for a, b, r in form.capsules]
            links[name, k] = unary_union([*shapes, foot] if k else shapes)
    rng, model = np.random.default_rng(seed), source.model
    parts = {}
    for name, leg in reading.legs.items():
        for k, joint in enumerate((leg.chain.thigh, leg.chain.calf)):
            parts[int(model.jnt_bodyid[joint])] = name, k
        parts[int(model.jnt_bodyid[leg.chain.wheel])] = name, 2
    seen = set()
    for geom in range(model.ngeom):
        if not model.geom_contype[geom] or model.geom_bodyid[geom] == 0:
            continue
        part = parts.get(int(model.geom_bodyid[geom]))
        cloud = reading.frame.place(_surface(source, geom, rng))
        if part is None:
            side = (cloud - reading.centre)[:, [0, 2]]
            assert trunk.buffer(1e-6).covers(MultiPoint(side))
        elif part[1] < 2:
            side = reading.legs[part[0]].side(cloud, part[1])
            shape = links[part[0][0], part[1]]
            assert shape.buffer(1e-4).covers(MultiPoint(side)), part
        seen.add(part and part[1])
    assert seen == {None, 0, 1, 2}


def _surface(source, geom: int, rng: np.random.Generator) -> np.ndarray:
    """(200, 3) random points on a shape, by its own formula, in the world."""
    size = source.model.geom_size[geom]
    kind = mujoco.mjtGeom(int(source.model.geom_type[geom]))
    u = rng.normal(size=(200, 3))
    u /= np.linalg.norm(u, axis=1)[:, None]
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        own = np.sign(u) * size
    elif kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        own = u * size[0]
    else:
        assert kind == mujoco.mjtGeom.mjGEOM_CYLINDER
        ring = u[:, :2] / np.linalg.norm(u[:, :2], axis=1)[:, None]
        own = np.column_stack([size[0] * ring, size[1] * np.sign(u[:, 2])])
    axes = source.data.geom_xmat[geom].reshape(3, 3)
    return source.data.geom_xpos[geom] + own @ axes.T
