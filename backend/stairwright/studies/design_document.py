"""The design document: what of the robot may vary, and what for."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from stairwright.arguments import MOST_SEED
from stairwright.documents import Model, content_hash
from stairwright.errors import InputError

from .axes import Axis, Number
from .document import Study
from .targets import target
from .variables import VARIABLES

MOST_DESIGNS = 100_000
MOST_AIMS = 3
MASS = "mass"


class Vary(Model):
    """A number of the robot's file, and its bounds."""

    name: str = Field(max_length=100, description="such as robot.calf.length or payload")
    between: tuple[Number, Number] = Field(description="least and most")
    log: bool = Field(False, description="try ratios evenly instead of differences")

    @model_validator(mode="after")
    def _check(self) -> Vary:
        low, high = self.between
        if low >= high:
            why = f"the low end {low:g} must lie below the high end {high:g}"
            raise InputError(why, ("between",))
        if self.log and low <= 0.0:
            raise InputError("must be above 0 where ratios are tried", ("between",))
        return self


class Aim(Model):
    """What to make small or large: a number that varies, `mass`, a result, or a border.

    With `between` and `tolerance` it is the last value of a quantity of the terrain, such as
    step.height, that a design passes; at most one aim is such a border.
    """

    minimise: str | None = Field(None, max_length=100)
    maximise: str | None = Field(None, max_length=100)
    between: tuple[Number, Number] | None = None
    tolerance: float | None = Field(None, strict=True, gt=0.0, le=1e9)

    @model_validator(mode="after")
    def _check(self) -> Aim:
        if (self.minimise is None) == (self.maximise is None):
            raise InputError("give either minimise or maximise", ("minimise",))
        if (self.between is None) != (self.tolerance is None):
            missing = "between" if self.between is None else "tolerance"
            raise InputError("Field required: between and tolerance go together", (missing,))
        return self

    @property
    def name(self) -> str:
        """Of the quantity."""
        return self.minimise or self.maximise or ""

    @property
    def direction(self) -> Literal["minimize", "maximize"]:
        """As Optuna calls it."""
        return "minimize" if self.maximise is None else "maximize"


class Ask(Study):
    """A study that needs no axes of its own: designs are one, and a border may be another."""

    axes: list[Axis] = Field([], max_length=4)


class Design(Model):
    """A design study (``stairwright/design/1``).

    A design is a robot with numbers of its file changed. It counts where every cell of `ask`, a
    study without the robot's own axes, passes: plans, rollouts or trials, as that computes.
    """

    schema_: Literal["stairwright/design/1"] = Field("stairwright/design/1", alias="schema")
    name: str = Field("", max_length=100)
    description: str = Field("", max_length=2000)
    ask: Ask = Field(description="what each design has to pass")
    vary: list[Vary] = Field(min_length=1, max_length=32)
    aims: Annotated[list[Aim], Field(min_length=1, max_length=MOST_AIMS)]
    designs: int = Field(200, strict=True, ge=1, le=MOST_DESIGNS, description="how many to try")
    generation: int = Field(8, strict=True, ge=1, le=1000, description="designs tried at once")
    seed: int = Field(0, strict=True, ge=0, le=MOST_SEED, description="of what is proposed")

    @model_validator(mode="after")
    def _check_design(self) -> Design:
        for i, axis in enumerate(self.ask.axes):
            if axis.name == "robot" or axis.boundary is not None:
                why = "designs vary the robot, and borders are aims"
                raise InputError(why, ("ask", "axes", i, "name"))
        names = [each.name for each in self.vary]
        for i, name in enumerate(names):
            try:
                where = target(name, self.ask.method)
            except InputError as error:
                raise error.within("vary", i, "name") from None
            if where.part not in ("robot_file", "payload"):
                raise InputError("must be a number of the robot", ("vary", i, "name"))
            if name in names[:i]:
                raise InputError(f"{name!r} is there twice", ("vary", i, "name"))
        self._check_aims()
        return self

    def _check_aims(self) -> None:
        numbers = [name for name, each in VARIABLES.items() if each.kind == "number"]
        known = (MASS, *(each.name for each in self.vary), *numbers)
        for i, aim in enumerate(self.aims):
            if aim.between is not None:
                try:
                    target(aim.name, self.ask.method)
                except InputError as error:
                    raise error.within("aims", i) from None
            elif aim.name not in known:
                raise InputError(
                    f"nothing is called {aim.name!r}; there are: {', '.join(known)}; a border "
                    "needs between and tolerance",
                    ("aims", i),
                )
            if aim.name in [other.name for other in self.aims[:i]]:
                raise InputError(f"{aim.name!r} is there twice", ("aims", i))
        if sum(aim.between is not None for aim in self.aims) > 1:
            raise InputError("only one aim may be a border", ("aims",))

    @property
    def border(self) -> Aim | None:
        """The aim that is searched for each design."""
        return next((aim for aim in self.aims if aim.between is not None), None)

    @property
    def names(self) -> list[str]:
        """Of all axes that each design is asked along."""
        return [axis.name for axis in self.ask.axes] + ([self.border.name] if self.border else [])

    @property
    def effort(self) -> int:
        """Plans, rollouts or trials that this takes, about: what budgets count."""
        one = self.asking({"d": self.ask.robot})
        return self.designs * one.effort

    def asking(self, robots: dict[str, Any]) -> Study:
        """The study that asks about some designs, by name."""
        axes = [Axis(name="robot", values=list(robots)), *self.ask.axes]
        border = self.border
        if border is not None:
            axes.append(Axis(name=border.name, boundary=border.between, tolerance=border.tolerance))
        return self.ask.model_copy(update={"axes": axes, "robots": robots})


def design_id(design: Design, engine: str) -> str:
    """Name of a design study whose terrain and robot are documents."""
    data = design.model_dump(mode="json", exclude={"name", "description"})
    for text in ("name", "description"):
        data["ask"].pop(text)
    return "d-" + content_hash([data, engine]).removeprefix("sha256:")
