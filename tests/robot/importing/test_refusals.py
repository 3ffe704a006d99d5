"""What is no robot of four wheeled legs is refused, by the name of the link or joint."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from stairwright.errors import InputError
from stairwright.robot.importing.read import read
from stairwright.robot.importing.report import Imported
from stairwright.robot.importing.upload import Upload
from tests.robot.importing.files import Design, LegQuirks
from tests.robot.importing.written import hinge, link, mjcf, urdf

MJCF, URDF = mjcf(Design()), urdf(Design())


def imported(text: str, **options: float) -> Imported:
    return read(Upload("a.xml", text.encode()), options)


def refused(text: str, **options: float) -> str:
    with pytest.raises(InputError) as caught:
        imported(text, **options)
    return str(caught.value)


def without_legs(text: str, *legs: str) -> str:
    """URDF whose legs end at the trunk."""
    for leg in legs:
        text = re.sub(rf'<(link|joint) name="{leg}_.*?</\1>', "", text, flags=re.DOTALL)
    return text


def one(text: str, name: str, old: str, new: str) -> str:
    """Change `old` in the element called `name`."""
    found = re.search(
        rf'<(link|joint|body) name="{name}".*?</\1>|<joint name="{name}"[^>]*>', text, re.DOTALL
    )
    assert found, name
    assert old in found[0], found[0]
    return text.replace(found[0], found[0].replace(old, new, 1), 1)


def test_two_legs() -> None:
    message = refused(without_legs(URDF, "RL", "RR"))
    assert "2 legs end in a wheel" in message
    assert "FL_wheel_joint" in message


def test_no_wheel_at_the_end() -> None:
    text = one(URDF, "RR_wheel_joint", 'type="continuous"', 'type="revolute"')
    message = refused(
        one(text, "RR_wheel_joint", 'velocity="40"', 'velocity="1" lower="-1" upper="1"')
    )
    assert "'RR_wheel' is no wheel" in message
    assert "3 of four" in message


def test_feet_in_the_place_of_wheels() -> None:
    text = URDF
    for leg in ("FL", "FR", "RL", "RR"):
        text = one(text, f"{leg}_wheel_joint", 'type="continuous"', 'type="fixed"')
    assert "is no wheel" in refused(text)


def test_axes_that_are_not_parallel() -> None:
    message = refused(one(URDF, "FR_calf_joint", 'xyz="0.0 1.0 0.0"', 'xyz="0.1 1.0 0.0"'))
    assert "FR_calf_joint" in message
    assert "5.7 degrees" in message
    message = refused(one(URDF, "FR_wheel_joint", 'xyz="0.0 1.0 0.0"', 'xyz="1.0 0.0 0.0"'))
    assert "FR_wheel" in message


def test_a_leg_that_swings_sideways() -> None:
    text = URDF
    for joint in ("thigh", "calf", "wheel"):
        text = one(text, f"FL_{joint}_joint", 'xyz="0.0 1.0 0.0"', 'xyz="1.0 0.0 0.0"')
    assert "FL_" in refused(text)


def test_closed_chains() -> None:
    closed = (
        '<equality><connect name="rod" body1="FL_calf" body2="FL_hip" anchor="0 0 0"/></equality>'
    )
    assert "rod" in refused(mjcf(Design(), extra=closed))
    tied = '<equality><joint joint1="FL_calf_joint" joint2="FR_calf_joint"/></equality>'
    assert "FL_calf_joint" in refused(mjcf(Design(), extra=tied))
    second = (
        '<joint name="rod" type="revolute"><parent link="FL_hip"/><child link="FL_calf"/>'
        '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    )
    message = refused(urdf(Design(), extra=second))
    assert "FL_calf" in message
    assert "rod" in message
    mimic = one(URDF, "FL_calf_joint", "<dynamics", '<mimic joint="FL_thigh_joint"/><dynamics')
    assert "'FL_calf_joint' follows 'FL_thigh_joint'" in refused(mimic)


def test_what_is_tied_on_the_trunk_alone_does_not_matter() -> None:
    """A gripper's fingers follow each other; the legs are open chains."""
    finger = (
        '<link name="{0}"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" '
        'ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="{0}_joint" type="revolute">'
        '<parent link="base"/><child link="{0}"/><axis xyz="0 0 1"/>{1}'
        '<limit lower="-1" upper="1" effort="9" velocity="9"/></joint>'
    )
    pair = finger.format("a", "") + finger.format("b", '<mimic joint="a_joint"/>')
    made = imported(urdf(Design(), extra=pair))
    assert made.locked["b_joint"] == 0.0


def test_links_that_hang_on_nothing() -> None:
    assert "orphan" in refused(urdf(Design(), extra='<link name="orphan"/>'))
    lost = '<joint name="odd" type="fixed"><parent link="base"/><child link="nowhere"/></joint>'
    assert "nowhere" in refused(urdf(Design(), extra=lost))


def test_one_joint_too_many() -> None:
    text = one(URDF, "FL_hip_joint", '<parent link="base"/>', '<parent link="turret"/>')
    turret = link("turret", 1.0) + hinge("steer", "base", "turret", "0 0 0", "0 0 1")
    text = text.replace("</robot>", f"{turret}</robot>")
    message = refused(text)
    assert "'steer'" in message
    assert "one joint too many" in message


def test_a_slide_in_a_leg() -> None:
    message = refused(one(URDF, "RL_hip_joint", 'type="revolute"', 'type="prismatic"'))
    assert "RL_hip_joint" in message


def test_legs_that_differ_left_and_right() -> None:
    other = one(URDF, "FR_calf_joint", "-0.22", "-0.25")
    assert "front thighs differ by 30 mm" in refused(other)
    unlike = refused(one(URDF, "FR_calf_joint", 'xyz="0.0 1.0 0.0"', 'xyz="0.0 -1.0 0.0"'))
    assert "'FL_calf_joint' and 'FR_calf_joint' have no angle in common" in unlike


def test_knees_that_hardly_bend() -> None:
    # The file counts its knees from 0.2054 rad.
    stiff = re.sub(
        r'(name="R[LR]_calf_joint".*?)lower="[^"]+" upper="[^"]+"',
        r'\1lower="0.18" upper="0.24"',
        URDF,
        flags=re.DOTALL,
    )
    assert "'RL_calf_joint' and 'RR_calf_joint' bend by no more than 0.05 rad" in refused(stiff)


def test_wheels_of_two_sizes() -> None:
    text = URDF
    for leg in ("RL", "RR"):
        text = one(text, f"{leg}_wheel", 'radius="0.08"', 'radius="0.1"')
    assert "front and rear wheels differ" in refused(text)


def test_all_legs_on_one_side() -> None:
    text = URDF
    for leg in ("FR", "RR"):
        text = one(text, f"{leg}_hip_joint", "-0.06", "0.5")
    assert "two legs on each side" in refused(text)


def test_a_weightless_link() -> None:
    text = one(URDF, "FL_thigh", 'mass value="1.1"', 'mass value="0.0"')
    assert "FL_thigh" in refused(text)


@pytest.mark.parametrize("tilt", [-0.5, 0.2, 1.5])
def test_a_tilt_out_of_the_side_view(tilt: float) -> None:
    assert refused(URDF, abduction=tilt).startswith("abduction: ")


def test_a_small_tilt_is_accepted_and_its_error_is_said() -> None:
    made = imported(URDF, abduction=0.1)
    assert made.robot.abduction == 0.1
    assert made.locked == pytest.approx(
        {"FL_hip_joint": 0.1, "FR_hip_joint": -0.1, "RL_hip_joint": 0.1, "RR_hip_joint": -0.1}
    )
    (warning,) = [each for each in made.warnings if "side view" in each]
    error = float(re.search(r"up to ([\d.e+-]+) mm", warning)[1])  # type: ignore[index]
    reach = made.robot.legs[0].reach
    assert 1e3 * reach * 0.004 < error < 1e3 * reach * 0.006  # 1 - cos 0.1 of the leg
    upright = imported(URDF).robot
    assert made.robot.hips.half_track > upright.hips.half_track - 1e-3


def test_other_joints_are_held_and_named() -> None:
    arm = link("arm", 0.5) + hinge("arm_joint", "base", "arm", "0.1 0 0.1", "0 1 0")
    made = imported(urdf(Design(), extra=arm))
    assert made.robot.mass == pytest.approx(imported(URDF).robot.mass + 0.5)
    assert made.locked["arm_joint"] == 0.0
    assert any("arm_joint" in each for each in made.warnings)


def test_abduction_whose_zero_is_not_upright() -> None:
    quirks = {leg: LegQuirks(zero=(0.4, 0, 0, 0)) for leg in ("FL", "FR", "RL", "RR")}
    made = imported(mjcf(replace(Design(), quirks=quirks, keyframe=False)))
    assert made.locked["FL_hip_joint"] == pytest.approx(-0.4)
    assert made.robot.hips.half_track == pytest.approx(imported(MJCF).robot.hips.half_track)


@pytest.mark.parametrize("text", [URDF, MJCF], ids=["urdf", "mjcf"])
def test_legs_that_steer_instead_of_tilting(text: str) -> None:
    steering = re.sub(r"(axis(?: xyz)?=)\"1(?:\.0)? 0(?:\.0)? 0(?:\.0)?\"", r'\1"0 0 1"', text)
    assert steering.count('"0 0 1"') == 4
    made, tilting = imported(steering).robot, imported(text).robot
    assert made.model_copy(update={"source": tilting.source}) == tilting
    assert "does not tilt the leg" in refused(steering, abduction=0.1)
