"""Study documents: what is taken, and how what is wrong is refused, at once and by name."""

from __future__ import annotations

import math
import time

import pytest

from stairwright.errors import InputError
from stairwright.studies.document import check_budget
from stairwright.studies.question import Questions, check_axes
from stairwright.studies.resolve import load_study
from stairwright.studies.study import prepared

from .small import STEP, study

HEIGHT = {"name": "step.height", "values": [0.1, 0.2]}


def _refused(document: object) -> InputError:
    begun = time.perf_counter()
    with pytest.raises(InputError) as caught:
        prepared(document)  # type: ignore[arg-type]
    assert time.perf_counter() - begun < 1.0
    return caught.value


@pytest.mark.parametrize(
    ("document", "field"),
    [
        (study(), "axes"),
        (study(HEIGHT, HEIGHT), "axes.1.name"),
        (study({"name": "step.height"}), "axes.0.values"),
        (study({"name": "step.height", "values": [0.1, 0.1]}), "axes.0.values"),
        (study({"name": "step.height", "values": [math.nan]}), "axes.0.values.0"),
        (study({"name": "step.height", "from": 0.1, "to": math.inf, "count": 3}), "axes.0.to"),
        (study({"name": "step.height", "from": 0.1, "to": 0.2}), "axes.0.count"),
        (study({"name": "step.height", "from": 0.1, "to": 0.2, "count": 10**9}), "axes.0.count"),
        (study({"name": "step.height", "boundary": [0.1, 0.2]}), "axes.0.tolerance"),
        (
            study({"name": "step.height", "boundary": [0.1, 0.2], "tolerance": 1e-9}),
            "axes.0.tolerance",
        ),
        (study({"name": "step.height", "values": ["high"]}), "axes.0.values"),
        (study({"name": "step.colour", "values": [1]}), "axes.0.name"),
        (study({"name": "robot.tail.length", "values": [1]}, HEIGHT), "axes.0"),
        (study({"name": "robot.thigh", "values": [1]}, HEIGHT), "axes.0"),
        (study({"name": "robot.name", "values": [1]}, HEIGHT), "axes.0"),
        (study({"name": "friction", "values": [0.5]}), "terrain"),
        (study(HEIGHT, {"name": "ramp.slope", "values": [0.3]}), "axes"),
        (study(HEIGHT, terrain="single-stair-036"), "axes.0.name"),
        (study(HEIGHT, robot="a dog"), "robot"),
        (study(HEIGHT, robot="/etc/passwd"), "robot"),
        ([HEIGHT], "study"),
        (study(HEIGHT, {"name": "robot", "values": ["a1_wheeled", "cat"]}), "axes.1.values.1"),
        (study({"name": "step.height", "values": [-1.0, 0.0]}), "axes.0"),
        (study(HEIGHT, colour="red"), "colour"),
        (study(HEIGHT, compute="magic"), "compute"),
        (study(*({"name": f"weights.w{i}", "values": [1]} for i in range(10_000))), "axes"),
        (study({"name": "seed", "values": [1]}, HEIGHT), "axes.0.name"),
    ],
)
def test_what_is_wrong_is_named(document: object, field: str) -> None:
    path = _refused(document).path
    assert path.startswith(field)
    assert "~" not in path


def test_a_part_that_a_robot_does_not_have() -> None:
    """M20 has motors of their own in thighs and calves: what there is is named."""
    document = study({"name": "robot.actuators.leg.torque", "values": [50]}, HEIGHT, robot="m20")
    refused = _refused(document)
    assert refused.path == "axes.0"
    assert "robot.actuators.leg.torque: no such part" in refused.message
    assert "calf, thigh, wheel" in refused.message


def test_too_much_is_refused_before_anything_is_made() -> None:
    axes = [
        {"name": name, "from": 0.1, "to": 0.9, "count": 10_000}
        for name in ("stairs.rise", "stairs.run", "friction")
    ]
    error = _refused(study(*axes))
    assert "1,000,000,000,000 cells" in error.message
    with pytest.raises(InputError, match="trials"):
        check_budget(load_study(STEP | {"compute": "trials"}), 100, "the budget")


def test_values_between_ends_do_not_depend_on_the_ends() -> None:
    short = load_study(study({"name": "step.height", "from": 0.1, "to": 0.3, "count": 21}))
    long = load_study(study({"name": "step.height", "from": 0.1, "to": 0.5, "count": 41}))
    assert set(short.axes[0].points) < set(long.axes[0].points)
    assert short.family == long.family


def test_every_kind_of_axis_reaches_its_place() -> None:
    made = Questions(
        load_study(
            study(
                {"name": "stairs.rise", "values": [0.12]},
                {"name": "stairs.tread", "values": [0.31]},
                {"name": "stairs.steps", "values": [2]},
                {"name": "friction", "values": [0.55]},
                {"name": "payload", "values": [3.5]},
                {"name": "speed", "values": [0.3]},
                {"name": "robot", "values": ["a1_wheeled_x"]},
                {"name": "robot.calf.length", "values": [0.22]},
            )
        )
    )
    question = made.at((0.12, 0.31, 2.0, 0.55, 3.5, 0.3, "a1_wheeled_x", 0.22))
    assert question.terrain.points[2:4] == [(0.0, 0.12), (0.31, 0.12)]
    assert question.friction == 0.55
    assert question.weights["speed"] == 0.3
    assert question.robot.name == "a1_wheeled_x"
    assert question.robot.calf.length == 0.22
    assert question.robot.payload is not None
    assert question.robot.payload.mass == 3.5
    units = [target.unit for target in made.targets]
    assert units == ["m", "m", "1", "1", "kg", "m/s", "1", "m"]


def test_parts_that_a_robot_leaves_out_can_vary() -> None:
    made = Questions(
        load_study(
            study(
                {"name": "robot.rear.calf.length", "values": [0.21]},
                {"name": "robot.trunk.size.2", "values": [0.1]},
                {"name": "robot.trunk.com.0", "values": [0.02]},
                HEIGHT,
            )
        )
    )
    robot = made.at((0.21, 0.1, 0.02, 0.1)).robot
    assert [leg.calf.length for leg in robot.legs] == [0.2, 0.21]
    assert robot.trunk.size[2] == 0.1
    assert robot.trunk.com == (0.02, 0.0, 0.0)


def test_one_good_value_is_enough() -> None:
    made = load_study(study({"name": "robot.nominal_height", "values": [0.3, 0.9]}, HEIGHT))
    check_axes(Questions(made))


def test_documents_of_robots_beside_the_presets() -> None:
    from stairwright.library import load_robot

    long = load_robot("a1_wheeled").model_dump(mode="json") | {"name": "long"}
    long["calf"]["length"] = 0.24
    made = load_study(
        study(HEIGHT, {"name": "robot", "values": ["a1_wheeled", "long"]}, robots={"long": long})
    )
    assert Questions(made).at((0.1, "long")).robot.calf.length == 0.24
