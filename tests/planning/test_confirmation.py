"""Named amounts are settled by all of planning, asked about every amount once."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stairwright.planning.attempt import Blocked, Solved
from stairwright.planning.infeasibility.bracket import Bracket
from stairwright.planning.infeasibility.confirmation import _settled, alone, strengthened
from stairwright.planning.problem import Limit
from stairwright.planning.strategy import AT_ONCE, FINER, ON_BRINKS, solve
from stairwright.planning.threads import in_this_thread


@dataclass
class Asked:
    """A quantity of which planning makes do with some numbers of steps of 2 %."""

    enough: set[int]
    most: float = 1.02**60
    steps: list[int] = field(default_factory=list)

    doubted: set[int] = field(default_factory=set)  # of those that some attempts do not do with

    def feasible(self, _planner, ratio, _pool):
        self.steps.append(round(math.log(ratio, 1.02)))
        return self.steps[-1] in self.enough

    def feasible_likewise(self, _planner, ratio):
        return round(math.log(ratio, 1.02)) in self.enough - self.doubted


@pytest.mark.parametrize(
    "enough",
    [
        {*range(24, 61)},
        {*range(12, 61)},  # less than the first
        {*range(14, 61)} - {18},  # with a gap
        {9, *range(12, 61)},  # far less
        {30, *range(33, 61)},  # more
        {30, 60},  # nothing but all that there may be
    ],
)
@pytest.mark.parametrize("doubted", [set(), {*range(25)}, {22, 16, 13}])
@pytest.mark.parametrize("failed", [(), (10, 22), (29,)])
def test_all_of_planning_is_asked_on_both_sides_and_about_no_amount_twice(enough, doubted, failed):
    quantity = Asked(enough, doubted=doubted)
    cause = _settled(SimpleNamespace(), quantity, 30, failed, in_this_thread())
    low, high = (round(math.log(ratio, 1.02)) for ratio in (cause.lower, cause.upper))
    assert high == low + 1
    assert low not in enough
    assert {high, min(high + 1, 60)} <= enough
    assert low in quantity.steps
    assert len(quantity.steps) == len(set(quantity.steps))


def test_what_searches_missed_is_found_by_asking_all_of_planning():
    planner = SimpleNamespace()
    cause = alone(planner, Asked({*range(9, 61)}), 1.02**40, in_this_thread())
    assert round(math.log(cause.upper, 1.02)) == 9
    assert alone(planner, Asked(set()), 1.02**40, in_this_thread()) is None


@given(
    st.integers(1, 70).flatmap(
        lambda most: st.tuples(
            st.just(most), st.integers(1, most), st.integers(1, 71), st.integers(1, 70)
        )
    )
)
def test_a_bracket_closes_round_what_works_whatever_is_asked_first(drawn):
    most, first, least, hole = drawn
    enough = {*range(least, most + 1)} - {hole}
    bracket = Bracket(most)
    asked = (first,)
    while asked:
        for step in asked:
            assert 0 < step <= most
            assert step not in bracket.known
            bracket.tell(step, step in enough)
            if bracket.known[step]:
                break
        asked = bracket.next_steps()
    assert len(bracket.known) <= 24
    if bracket.high is None:
        assert most not in enough
    else:
        assert bracket.high in enough
        assert bracket.low == bracket.high - 1 not in enough
        assert min(bracket.high + 1, most) in enough


def test_what_attempts_have_missed_is_looked_for_near_by():
    bracket = Bracket(60)
    bracket.tell(10, works=False, settled=False)
    bracket.tell(30, works=True)
    asked = []
    while (step := bracket.next_steps()[0]) > 24 or not bracket.settles(step):
        asked.append(step)
        bracket.tell(step, step >= 25, settled=False)
    assert (step, asked) == (24, [23, 27, 25, 24])
    bracket.tell(24, works=True)
    downward = []
    for _ in range(3):
        downward += bracket.next_steps()
        bracket.tell(downward[-1], works=True)
    assert downward == [22, 18, 10]


@pytest.mark.parametrize(("weak", "asked"), [("leg", 1), ("wheel", 6)])
def test_motors_are_not_made_stronger_where_others_are_too_weak(weak, asked):
    made = []

    def attempt(_planner, ratio):
        made.append(ratio)
        return Blocked((0.0, 0.0), True, weak, share=0.91)

    wheels = SimpleNamespace(quantity="wheel torque", most=10.0, attempt=attempt)
    assert strengthened(SimpleNamespace(), wheels, 1.0, in_this_thread()) is None
    assert len(made) == asked


def test_attempts_that_are_likely_to_lead_are_made_before_others():
    made = []

    def attempt(which):
        made.append(which)
        if which == FINER:
            return Solved(SimpleNamespace(), SimpleNamespace())
        return Blocked((0.0, 0.0), True)

    planner = SimpleNamespace(attempt=attempt, torques=True, thin=0.01, unweighted=None)
    likely = [(ON_BRINKS, False), (FINER, True)]
    found = solve(planner, in_this_thread(), any_path=True, likely=likely)
    assert isinstance(found, Solved)
    assert made == [AT_ONCE, FINER]


@pytest.mark.parametrize(
    ("margin", "clearance", "compared"), [(0.005, 0.5, 3), (0.5, 0.001, 2), (0.5, 0.5, 1)]
)
def test_where_any_path_will_do_a_thin_one_is_not_compared(margin, clearance, compared):
    def asked(**how):
        made = []

        def attempt(which):
            made.append(which)
            return Solved(SimpleNamespace(), SimpleNamespace())

        other = SimpleNamespace(again=lambda which, torques: attempt(which))
        planner = SimpleNamespace(
            attempt=attempt, how=lambda _: (AT_ONCE, False), steadier=other, clearer=other,
            torques=False, thin=0.01, near=0.005,
        )  # fmt: skip
        return solve(planner, in_this_thread(), **how), made

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Solved, "margin", margin)
        patch.setattr(Solved, "trunk_clearance", clearance)
        patch.setattr(Solved, "torque_share", 0.5)
        patch.setattr(Solved, "grazes", False)
        found, made = asked(any_path=True)
        assert isinstance(found, Solved)
        assert made == [AT_ONCE]
        assert len(asked()[1]) == compared


def test_what_is_missing_is_told_in_words():
    legs = Limit(
        needed=0.5, available=0.4, quantity="leg length", unit="m", given={"friction": 1.5}
    )
    assert str(legs) == "needs leg length 0.5 m with friction 1.5, has 0.4 m"
    trunk = Limit(needed=0.1, available=0.1787, quantity="trunk height", unit="m")
    assert str(trunk) == "needs trunk height of at most 0.1 m, has 0.179 m"
    motor = Limit(needed=36.28, available=33.5, quantity="leg torque", unit="Nm")
    assert str(motor) == "needs leg torque 36.3 Nm, has 33.5 Nm"
