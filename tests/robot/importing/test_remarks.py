"""Numbers that a file has twice or not at all, and what is said about them."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import pytest

import stairwright as sw
from stairwright.export.table import ROBOT_FORMATS
from stairwright.robot.importing.read import read
from stairwright.robot.importing.report import Imported
from stairwright.robot.importing.upload import Upload
from tests.robot.importing.files import LEGS, Design, LegQuirks
from tests.robot.importing.written import mjcf, urdf


def imported(text: str, **options: float) -> Imported:
    return read(Upload("a.xml", text.encode()), options)


def said(remarks: list[str], *words: str) -> bool:
    return any(all(word in each for word in words) for each in remarks)


def telling(made: Imported, field: str) -> str:
    """The sentence that says what was assumed of a field."""
    return made.robot.assumed[made.robot.assumed_fields[field]]


def test_motors_of_urdf() -> None:
    made = imported(urdf(Design()))
    motors = made.robot.actuators
    limits = {
        part: (motors.of(part).torque, motors.of(part).speed) for part in ("thigh", "calf", "wheel")
    }
    assert limits == {"thigh": (24, 30), "calf": (35, 20), "wheel": (15, 40)}
    assert motors.of("calf").damping == 0.05
    assert telling(made, "actuators.calf.armature").startswith("calf rotor inertia")
    assert "actuators.calf.torque" not in made.robot.assumed_fields
    assert said(made.assumed, "rotor inertia", "URDF has no place")


def test_a_torque_limit_in_two_places() -> None:
    made = imported(mjcf(Design()))
    assert made.robot.actuators.of("calf").torque == 35  # of 45 in the actuator
    assert said(made.warnings, "FL_calf_joint", "45 Nm", "35 Nm", "two places")
    assert made.robot.actuators.of("thigh").armature == 0.01
    assert said(made.assumed, "speed", "MJCF names none")


def test_position_servos_limit_by_force_not_by_angle() -> None:
    servos = "".join(
        f'<position joint="{leg}_{part}_joint" kp="50" ctrlrange="-3 3" forcerange="-20 20" '
        'gear="2"/>'
        for leg in LEGS for part in ("thigh", "calf", "wheel")
    )  # fmt: skip
    made = imported(mjcf(Design(), motors=servos))
    assert made.robot.actuators.of("thigh").torque == 40


def test_no_limit_at_all_is_assumed_and_placeholders_are_noticed() -> None:
    made = imported(mjcf(Design(), motors="").replace('actuatorfrcrange="-35 35"', ""))
    assert said(made.assumed, "thigh torque", "what holds half the weight at 0.7")
    made = imported(urdf(Design()).replace('velocity="40"', 'velocity="200"'))
    assert said(made.warnings, "200 rad/s", "placeholder")


def test_ranges_beyond_whole_turns() -> None:
    wide = replace(Design(), thigh_range=(-9.42, 9.42), calf_range=(-9.42, 9.42))
    made = imported(urdf(wide))
    assert made.robot.joints.front.calf == pytest.approx((-9.42, 9.42))
    assert said(made.warnings, "exceeds a whole turn")
    assert said(made.warnings, "front knees bend both ways")


def test_a_joint_without_a_range() -> None:
    text = urdf(Design()).replace('type="revolute"', 'type="continuous"')
    assert "once round" in telling(imported(text), "joints.rear.calf")


def test_a_range_that_is_a_slip() -> None:
    """As the -94 in a maker's xacro, which was to be -0.94."""
    text = urdf(Design()).replace('lower="-1.2"', 'lower="-94"', 1)
    made = imported(text)
    assert made.robot.joints.front.thigh == pytest.approx((-1.2, 2.9))  # what both sides can
    assert said(made.warnings, "FL_thigh_joint", "-94", "slip")


def test_wheel_meshes_that_were_not_sent() -> None:
    for write, shown in ((urdf, "tyre.dae"), (mjcf, "tyre.stl")):
        made = imported(write(replace(Design(), wheel_mesh=True)))
        disc = (2 * 0.0016 / 0.55) ** 0.5
        assert made.robot.wheel.radius == pytest.approx(disc)
        assert said(made.warnings, "not sent", shown)
        assert said(made.warnings, "radius", "guess")
        assert "disc" in telling(made, "wheel.radius")
        assert not said(made.warnings, "body")  # a mesh that only shows
        given = imported(write(replace(Design(), wheel_mesh=True)), wheel_radius=0.09)
        assert given.robot.wheel.radius == 0.09
        assert not said(given.warnings, "guess")


def test_gaps_are_filled_from_a_known_robot_with_the_same_legs() -> None:
    whole = imported(urdf(Design())).robot.model_copy(update={"name": "known"})
    text = mjcf(replace(Design(), wheel_mesh=True))
    made = read(Upload("a.xml", text.encode()), {}, [sw.load_robot("a1_wheeled"), whole])
    assert made.robot.wheel.radius == pytest.approx(0.08)
    assert made.robot.actuators.of("thigh").speed == 30
    assert said(made.assumed, "wheel radius", "preset known")
    heavier = urdf(Design()).replace('effort="35"', 'effort="60"')
    other = read(Upload("a.urdf", heavier.encode()), {}, [whole])
    assert said(other.warnings, "calf torque", "60 here", "35 in the preset known")


def test_shapes_without_mass_weigh_as_in_mujoco_and_it_is_said() -> None:
    fixed = (
        '<link name="guard"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
        '</link><joint name="guard_joint" type="fixed"><parent link="base"/><child link="guard"/>'
        "</joint>"
    )
    made = imported(urdf(Design(), extra=fixed))
    assert made.robot.mass == pytest.approx(imported(urdf(Design())).robot.mass + 1.0)
    assert said(made.warnings, "guard", "without <inertial>", "1 kg")


def test_impossible_inertias() -> None:
    flat = urdf(Design()).replace('ixx="0.03"', 'ixx="0.9"', 1)
    assert said(imported(flat).warnings, "base", "moments of inertia")
    none = urdf(Design()).replace('ixx="0.03"', 'ixx="0"', 1)
    assert said(imported(none).warnings, "base", "not positive")


@pytest.mark.parametrize(
    "shape",
    ['<cylinder radius="0" length="0"/>', '<box size="0.1 0 0.1"/>', '<sphere radius="0.0"/>'],
)
def test_shapes_of_no_size_are_left_out_and_it_is_said(shape: str) -> None:
    whole = urdf(Design())
    added = f"<collision><geometry>{shape}</geometry></collision></link>"
    made = imported(whole.replace("</collision></link>", f"</collision>{added}", 1))
    assert said(made.warnings, "without a volume", "base")
    assert made.robot.trunk == imported(whole).robot.trunk


def test_maps_are_said() -> None:
    quirks = {leg: LegQuirks((1, -1, -1, -1), (0, 0.3, 0, 0)) for leg in LEGS}
    made = imported(mjcf(replace(Design(), quirks=quirks, keyframe=False)))
    assert made.joints["RR_thigh"].sign == -1
    assert made.joints["RR_thigh"].offset == pytest.approx(0.3)
    assert said(made.warnings, "12 of 12 joints turn about -y")
    assert said(made.warnings, "zero angles shifted", "RL_thigh")
    assert said(made.assumed, "sign * (ours - offset)")


def test_the_height_is_the_keyframes_or_a_bent_knees() -> None:
    design = Design()
    keyed = imported(mjcf(design)).robot
    drop = design.thigh * math.cos(0.75) + design.calf * math.cos(0.75 - 1.45)
    assert keyed.nominal_height == pytest.approx(drop + design.radius, abs=1e-9)
    bent = imported(urdf(design))
    reach = math.sqrt(
        design.thigh**2 + design.calf**2 + 2 * design.thigh * design.calf * math.cos(1.5)
    )
    assert bent.robot.nominal_height == pytest.approx(reach + design.radius)
    assert telling(bent, "nominal_height").startswith("nominal_height")


def test_a_robot_of_ours_comes_back() -> None:
    """Through URDF and MJCF, which have no place for some of its numbers."""
    robot = sw.load_robot("a1_wheeled_x")
    for form in ("urdf", "mjcf"):
        text = ROBOT_FORMATS[form].write(robot).decode()
        back = imported(text).robot
        assert back.mass == pytest.approx(robot.mass)
        assert back.trunk.inertia == pytest.approx(robot.trunk.inertia)
        assert back.joints == robot.joints
        assert back.hips == robot.hips
        for own, other in zip(robot.legs, back.legs, strict=True):
            assert other.thigh.com == pytest.approx(own.thigh.com)
            assert other.calf.inertia == pytest.approx(own.calf.inertia)
            assert other.thigh_motor.torque == own.thigh_motor.torque


def test_a_calf_that_is_guessed_touches_nothing_that_its_wheel_rolls_on() -> None:
    def without_calves(radius: float) -> Imported:
        shapes = r'(?<=</inertial>)<collision>.*?(?=</link>\n<joint name="\w\w_calf_joint")'
        return imported(re.sub(shapes, "", urdf(Design(radius=radius))))

    rod, thin = without_calves(0.08).robot.calf, without_calves(0.02).robot.calf
    assert rod.radius > 0.7 * 0.02
    assert thin.radius == pytest.approx(0.7 * 0.02)
