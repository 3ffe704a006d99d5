"""The maker's own model under our controller."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import get_args

import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.robot import kinematics
from stairwright.robot.importing.read import read
from stairwright.robot.importing.upload import Upload
from stairwright.robot.turning import Facing, turned
from stairwright.simulation.original import Original, build_original, read_original
from stairwright.simulation.original_physics import Mirror
from tests.robot.importing.files import LEGS, Design, LegQuirks
from tests.robot.importing.written import hinge, link, mjcf, urdf

CURB = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
# Signs, zero angles and link frames of another maker; the base's frame is not the hips' middle.
ODD = replace(
    Design(),
    quirks={leg: LegQuirks((-1, -1, 1, -1), (0.2, 0.4, -0.7, 1.0)) for leg in LEGS},
    frames=(0.5, -0.3),
    keyframe=False,
)


def as_read(text: str) -> tuple[str, sw.Robot]:
    return text, read(Upload("a.xml", text.encode()), {}).robot


@cache
def robot(design_is_odd: bool, form: str) -> tuple[str, sw.Robot]:
    write = mjcf if form == "mjcf" else urdf
    return as_read(write(ODD if design_is_odd else Design()))


def built(text: str, machine: sw.Robot, facing: Facing = "forward") -> Original:
    upload, reading = read_original(text, machine, facing)
    return build_original(upload, reading, machine, sw.load_terrain(CURB), 0.6, facing)


def mirror(odd: bool, form: str, facing: Facing = "forward") -> tuple[Mirror, sw.Robot]:
    text, machine = robot(odd, form)
    if facing == "backward":
        machine = turned(machine)
    return Mirror(built(text, machine, facing)), machine


@pytest.mark.parametrize("facing", get_args(Facing))
@pytest.mark.parametrize("form", ["mjcf", "urdf"])
@pytest.mark.parametrize("odd", [False, True])
def test_a_state_reads_in_our_layout_as_it_was_placed(odd: bool, form: str, facing: Facing) -> None:
    seen, machine = mirror(odd, form, facing)
    rng = np.random.default_rng(3)
    limits = machine.joints.front
    pitch = -0.4
    q = np.array([rng.uniform(*pair) for pair in (limits.thigh, limits.calf) * 2])
    seen.qpos[:3] = 0.3, 0.0, 2.0
    seen.qpos[3:7] = np.cos(pitch / 2), 0.0, np.sin(pitch / 2), 0.0
    seen.qpos[7:] = [*q[:2], 0.0, *q[:2], 0.0, *q[2:], 0.0, *q[2:], 0.0]
    wanted = seen.qpos.copy()
    seen.place()
    np.testing.assert_allclose(seen.qpos, wanted, atol=1e-9)
    frames = kinematics.forward(machine, *map(np.asarray, (0.3, 2.0, pitch)), q)
    own, data = seen.original, seen.data
    for k, (body, plane) in enumerate(zip(own.wheels, own.planes, strict=True)):
        place = data.xpos[body] + data.xmat[body].reshape(3, 3) @ plane
        np.testing.assert_allclose(place[[0, 2]], frames.wheels[k // 2], atol=1e-9)


@pytest.mark.parametrize("facing", get_args(Facing))
@pytest.mark.parametrize("odd", [False, True])
def test_speeds_are_those_of_the_positions(odd: bool, facing: Facing) -> None:
    """Velocities read so are the differences of positions read so."""
    import mujoco

    seen, machine = mirror(odd, "mjcf", facing)
    seen.qpos[2], seen.qpos[3] = 2.0, 1.0
    middle = [sum(pair) / 2 for pair in (machine.joints.front.thigh, machine.joints.front.calf)]
    seen.qpos[7:] = [*middle, 0.0] * 4
    seen.place()
    rng = np.random.default_rng(1)
    seen.data.qvel[:] = rng.normal(size=seen.original.model.nv)
    mujoco.mj_forward(seen.original.model, seen.data)
    seen.read()
    before, speed, dt = seen.qpos.copy(), seen.qvel.copy(), 1e-6
    mujoco.mj_integratePos(seen.original.model, seen.data.qpos, seen.data.qvel, dt)
    mujoco.mj_forward(seen.original.model, seen.data)
    seen.read()
    np.testing.assert_allclose((seen.qpos - before)[:3] / dt, speed[:3], atol=1e-4)
    np.testing.assert_allclose((seen.qpos - before)[7:] / dt, speed[6:], atol=1e-4)
    spin = np.zeros(3)
    mujoco.mju_subQuat(spin, seen.qpos[3:7], before[3:7])
    np.testing.assert_allclose(spin / dt, speed[3:6], atol=1e-4)


def test_masses_and_shapes_are_the_files() -> None:
    seen, machine = mirror(True, "mjcf")
    assert seen.original.model.body_mass.sum() == pytest.approx(machine.mass)
    assert {"trunk", "FL_thigh", "RR_wheel", "terrain_0"} <= set(seen.original.labels)
    assert seen.original.model.nu == 12 + 4


def test_urdf_gets_the_rotors_that_it_has_no_place_for() -> None:
    seen, machine = mirror(True, "urdf")
    own = seen.original
    rotors = [motor.armature for motor in machine.motors]
    assert min(rotors) > 0.0
    np.testing.assert_allclose(own.model.dof_armature[own.speeds], rotors)


def test_balls_in_the_place_of_wheels_touch_the_terrain_and_each_other() -> None:
    own = built(*as_read(urdf(replace(Design(), wheel_mesh=True))))
    bits = {
        label: (int(own.model.geom_contype[geom]), int(own.model.geom_conaffinity[geom]))
        for geom, label in enumerate(own.labels)
        if own.model.geom_contype[geom]
    }

    def touch(first: str, second: str) -> bool:
        (a, b), (c, d) = bits[first], bits[second]
        return bool(a & d or c & b)

    assert touch("FL_wheel", "terrain_0")
    assert touch("FL_wheel", "RL_wheel")
    assert touch("FL_thigh", "terrain_0")
    assert not touch("FL_wheel", "trunk")


def test_an_arm_that_lies_on_the_trunk_does_not_collide_with_it() -> None:
    shape = '<collision><geometry><box size="0.3 0.1 0.1"/></geometry></collision></link>'
    arm = link("arm", 1.0).replace("</link>", shape) + link("hand", 0.2).replace("</link>", shape)
    arm += hinge("arm_joint", "base", "arm", "0 0 0.05", "0 1 0")
    arm += hinge("hand_joint", "arm", "hand", "0.1 0 0", "0 1 0")
    own = built(*as_read(urdf(Design(), extra=arm)))
    seen = Mirror(own)
    seen.qpos[:4] = 0.3, 0.0, 5.0, 1.0
    seen.place()
    touching = seen.data.contact.geom[: seen.data.ncon]
    assert [(own.labels[a], own.labels[b]) for a, b in touching] == []


def test_shapes_that_overlap_as_it_stands_do_not_collide() -> None:
    """Makers draw a trunk over the hips' motors, and train without collisions of their own."""
    text, machine = as_read(mjcf(Design()).replace('size="0.19 0.05 0.06"', 'size="0.19 0.2 0.06"'))
    own = built(text, machine)
    seen = Mirror(own)
    seen.qpos[:4] = 0.3, 0.0, 5.0, 1.0
    seen.qpos[7:] = kinematics.all_joints(kinematics.standing_joints(machine))
    seen.place()
    assert seen.data.ncon == 0


def test_a_knee_bends_as_far_as_its_range_says() -> None:
    """Hips are drawn so large that wheels meet them a little before, whatever the thighs do."""
    design, text = Design(), mjcf(Design())
    for leg in LEGS:
        y = design.side if leg[1] == "L" else -design.side
        motor = f'<geom class="touch" type="sphere" size="0.07" pos="0 {y} 0"/>'
        text = text.replace(f'<body name="{leg}_thigh"', f'{motor}<body name="{leg}_thigh"')
    text, machine = as_read(text)
    seen = Mirror(built(text, machine))
    ends = []
    for thigh in (0.0, 2.0):
        legs = [angle for leg in machine.legs for angle in (thigh, leg.limits.calf[0])]
        seen.qpos[:4] = 0.3, 0.0, 5.0, 1.0
        seen.qpos[7:] = kinematics.all_joints(np.array(legs))
        seen.place()
        ends.append(seen.data.ncon)
    assert ends == [0, 0]


def test_what_does_not_fit_is_refused() -> None:
    text, _ = robot(False, "mjcf")
    plan = sw.plan(CURB, "a1_wheeled")
    with pytest.raises(InputError, match="model: is another robot"):
        sw.rollout(plan, model=text)
    with pytest.raises(InputError, match="model: "):
        sw.rollout(plan, model="<mujoco/>")
    with pytest.raises(InputError, match="cannot read"):
        sw.rollout(plan, model="nowhere.xml")
    text, machine = robot(False, "mjcf")
    with pytest.raises(InputError, match=r"disturbance\.mass"):
        sw.rollout(sw.plan(CURB, machine), model=text, disturbance={"mass": 0.1})


@pytest.mark.slow
def test_a_step_is_climbed_by_the_original() -> None:
    """By an odd one from URDF; `tests/cli/test_robot_commands.py` rolls a plain one of MJCF out."""
    text, machine = robot(True, "urdf")
    plan = sw.plan({"points": [(-0.5, 0), (0, 0), (0, 0.2), (0.5, 0.2)]}, machine)
    settings = {"speed": 1.0}
    ours, theirs = (sw.rollout(plan, controller=settings, model=m) for m in (None, text))
    assert ours.success
    assert theirs.success, theirs.reason
    assert theirs.metrics.link_contacts == 0
    assert theirs.id != ours.id
    assert "FL_calf <- FL_calf_joint" in theirs.model
    assert theirs.metrics.duration == pytest.approx(ours.metrics.duration, rel=0.1)


@pytest.mark.slow
def test_the_original_goes_backward() -> None:
    """Down a step with its rear in front."""
    text, machine = robot(True, "urdf")
    step = {"points": [(-0.4, 0.15), (0, 0.15), (0, 0), (0.4, 0)]}
    plan = sw.plan(step, machine, facing="backward", timing="fast")
    theirs = sw.rollout(plan, model=text)
    assert theirs.success, theirs.reason
    assert "FL_calf <- RR_calf_joint" in theirs.model
    assert theirs.series.base_position[-1, 0] > 0.2
