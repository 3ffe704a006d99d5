"""Robots that look along another axis of their trunk, or whose trunk lies on its side."""

from __future__ import annotations

import math

import pytest

from stairwright.robot.importing.read import read
from stairwright.robot.importing.report import Imported
from stairwright.robot.importing.upload import Upload
from tests.robot.importing.files import LEGS, Design
from tests.robot.importing.written import mjcf

PLAIN = mjcf(Design())
HALF = math.sqrt(0.5)


def imported(text: str) -> Imported:
    return read(Upload("a.xml", text.encode()), {})


def turned(inside: str, body: str = "1 0 0 0") -> str:
    """The robot with everything in its trunk turned by `inside`, and the trunk by `body`."""
    start = PLAIN.index('<geom class="shown"')
    end = PLAIN.index("</body></worldbody>")
    text = PLAIN[:start] + f'<frame quat="{inside}">' + PLAIN[start:end] + "</frame>" + PLAIN[end:]
    return text.replace('<body name="base" pos', f'<body name="base" quat="{body}" pos')


@pytest.fixture(scope="module")
def plain() -> Imported:
    return imported(PLAIN)


@pytest.mark.parametrize(
    ("inside", "body"),
    [
        (f"{HALF} 0 0 {HALF}", "1 0 0 0"),  # the robot looks along the trunk's y
        (f"{HALF} {-HALF} 0 0", f"{HALF} {HALF} 0 0"),  # the trunk's y is up
        ("1 0 0 0", f"{HALF} 0 0 {HALF}"),  # it stands turned in the world
        ("1 0 0 0", "0.5 0.5 0.5 0.5"),  # and lies on its side there
    ],
)
def test_the_legs_are_the_same(inside: str, body: str, plain: Imported) -> None:
    made = imported(turned(inside, body))
    for own, other in zip(made.robot.legs, plain.robot.legs, strict=True):
        assert own.hip == pytest.approx(other.hip)
        assert own.thigh.com == pytest.approx(other.thigh.com)
        assert own.limits.calf == pytest.approx(other.limits.calf)
    assert made.robot.hips.half_track == pytest.approx(plain.robot.hips.half_track)
    assert made.robot.mass == pytest.approx(plain.robot.mass)
    names = {leg: made.joints[f"{leg}_thigh"].name for leg in LEGS}
    assert names == {leg: f"{leg}_thigh_joint" for leg in LEGS}
    if inside != "1 0 0 0":
        assert any("looks along" in each or "up is" in each for each in made.assumed)


def test_a_robot_that_stands_askew_in_its_trunk_is_refused() -> None:
    angle = math.radians(30) / 2
    with pytest.raises(ValueError, match="along none of the axes of 'base'"):
        imported(turned(f"{math.cos(angle)} 0 0 {math.sin(angle)}"))
