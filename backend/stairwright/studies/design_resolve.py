"""What a design search asks: names resolved, and refused if it is too much or makes no question."""

from __future__ import annotations

from stairwright.errors import InputError
from stairwright.robot.description import Robot

from .design_document import Design
from .question import Questions, varied_robot
from .resolve import FindRobot, FindTerrain, resolve
from .targets import target


def resolved_design(
    chosen: Design, find_terrain: FindTerrain, find_robot: FindRobot, budget: int, setting: str
) -> Design:
    """The same with names resolved by whoever knows them; `setting` is what raises the budget.

    Raises:
        InputError: With the field that is wrong.
    """
    if chosen.effort > budget:
        raise InputError(
            f"{chosen.effort:,} cells are more than the budget of {budget:,}; try fewer designs, "
            f"or raise {setting}",
            ("designs",),
        )
    try:
        ask = resolve(chosen.ask, find_terrain, find_robot, chosen.names)
    except InputError as error:
        raise error.within("ask") from None
    robot = ask.robot
    assert isinstance(robot, Robot)
    chosen = chosen.model_copy(update={"ask": ask})
    try:
        questions = Questions(chosen.asking({"d": robot}))
        questions.at([axis.points[0] for axis in questions.study.axes])
    except InputError as error:
        raise error.within("ask") from None
    for i, each in enumerate(chosen.vary):
        failures = []
        for end in each.between:
            try:
                varied_robot(robot, [(target(each.name), end)])
            except InputError as error:
                failures.append(error)
        if len(failures) == 2:
            why = f"neither end makes a robot: {failures[0]}"
            raise InputError(why, ("vary", i, "between"))
    return chosen
