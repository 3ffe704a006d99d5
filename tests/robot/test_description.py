"""Robot files: Table I of the paper, and errors that name the field."""

import pytest

from stairwright.errors import InputError
from stairwright.library import load_robot, robots
from stairwright.robot.mujoco_model import build_model


def test_table_one():
    robot = load_robot("a1_wheeled")
    assert robot.mass == pytest.approx(11.84)
    assert robot.trunk.size == (0.247, 0.194, 0.114)
    assert robot.trunk.inertia == (0.0214, 0.0535, 0.0443)
    assert (robot.thigh.length, robot.calf.length, robot.wheel.radius) == (0.2, 0.2, 0.05)
    assert robot.actuators.leg.torque == 33.5
    assert robot.actuators.leg.speed == 21.0
    assert robot.collision_points.count == 25
    assert robot.nominal_height == 0.33


def test_knees():
    own = {"a1_wheeled", "a1_wheeled_x", "go2w", "b2w", "m20", "d1", "anymal_wheels"}
    assert set(robots()) == own
    both_back, facing = load_robot("a1_wheeled"), load_robot("a1_wheeled_x")
    assert (both_back.legs[0].knee, both_back.legs[1].knee) == (-1, -1)
    assert (facing.legs[0].knee, facing.legs[1].knee) == (1, -1)
    assert both_back.hash != facing.hash


@pytest.mark.parametrize(
    ("where", "value", "path"),
    [
        (("joints", "front", "calf"), [-1.0, 1.0], "joints.front.calf"),
        (("joints", "rear", "thigh"), [1.0, -1.0], "joints.rear.thigh"),
        (("hips", "rear"), [-0.2, 0.0], "hips.rear"),
        (("hips", "front"), [-0.2, 0.0], "hips.front"),
        (("nominal_height",), 0.5, "nominal_height"),
        (("thigh", "mass"), -1, "thigh.mass"),
        (("wheel", "radius"), "big", "wheel.radius"),
        (("thigh", "length"), 1e-20, "thigh.length"),
        (("thigh", "mass"), 1e-16, "thigh.mass"),
        (("wheel", "mass"), 1e-17, "wheel.mass"),
        (("trunk", "inertia"), [1.0, 1.0, 100.0], "trunk.inertia"),
        (("calf", "inertia"), [0.1, 0.001, 0.001], "calf.inertia"),
        (("wheel", "inertia"), [1.0, 1e-9, 1e-9], "wheel.inertia"),
        (("trunk", "inertia"), [1e-16, 1e-16, 1e-16], "trunk.inertia.0"),
    ],
)
def test_bad_robot_is_refused_at_its_field(where, value, path):
    data = load_robot("a1_wheeled").model_dump(mode="json")
    inner = data
    for key in where[:-1]:
        inner = inner[key]
    inner[where[-1]] = value
    with pytest.raises(InputError) as caught:
        load_robot(data)
    assert caught.value.path == path


def test_the_simulator_takes_the_lightest_robot():
    """What validation accepts at its bounds, MuJoCo does too."""
    data = load_robot("a1_wheeled").model_dump(mode="json")
    for part in ("trunk", "thigh", "calf", "wheel"):
        data[part] |= {"mass": 1e-6, "inertia": [1e-12, 1e-12, 2e-12]}
    data["thigh"]["length"] = 1e-3
    data["nominal_height"] = 0.2
    model = build_model(load_robot(data))
    assert model.body("trunk").mass == pytest.approx(1e-6)


@pytest.mark.parametrize(("mass", "length"), [(700.0, 0.65), (1e3, 500.0)])
def test_the_largest_robots_have_gains(mass, length):
    """Stiffness in proportion to weight and legs, as far as documents may say it."""
    data = load_robot("a1_wheeled").model_dump(mode="json")
    data |= {"schema": "stairwright/robot/2", "gains": None}
    data["trunk"] |= {"mass": mass, "inertia": [mass, mass, mass]}
    for part in ("thigh", "calf"):
        data[part] |= {"length": length}
    data["nominal_height"] = 1.5 * length
    robot = load_robot(data)
    wanted = 40.0 * robot.mass / 11.84 * 2 * length / 0.4
    assert robot.feedback.joint_stiffness == pytest.approx(min(wanted, 1e6))
