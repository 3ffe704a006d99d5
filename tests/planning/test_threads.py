"""Work that is asked at once: answers in order, and no work for answers that nobody takes."""

import sys
import threading
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from stairwright.planning.lattice import windows
from stairwright.planning.lattice.body_lattice import STRICT
from stairwright.planning.lattice.windows import Searches, search_between
from stairwright.planning.standing import StandingPose
from stairwright.planning.threads import Abandoned, race, search_threads, still_wanted


@pytest.fixture(autouse=True)
def planning_threads() -> None:
    """They are used here."""


def test_answers_come_in_the_order_of_the_questions():
    second = threading.Event()

    def ask(k: int) -> int:
        assert second.wait(10.0) if k == 0 else True
        second.set()
        return k * k

    with race(search_threads(), ask, (0, 1)) as answers:
        assert list(answers) == [0, 1]


def test_what_is_not_taken_is_abandoned():
    begun, ended, asked = threading.Event(), threading.Event(), []

    def ask(k: int) -> bool:
        asked.append(k)
        if k == 0:
            return begun.wait(10.0)
        begun.set()
        try:
            while not ended.wait(0.001):
                still_wanted()
        except Abandoned:
            ended.set()
            raise
        return False

    pool = search_threads()
    with race(pool, ask, (0, 1)) as answers:
        assert next(answers)
    assert ended.wait(10.0)
    assert sorted(asked) == [0, 1]
    assert pool.submit(still_wanted).result() is None  # the thread's next work is wanted


def test_errors_reach_who_asks():
    def ask(k: int) -> float:
        return 1 / k

    with pytest.raises(ZeroDivisionError), race(search_threads(), ask, (0, 1)) as answers:
        next(answers)


def test_work_outside_a_race_is_always_wanted():
    still_wanted()


@pytest.mark.slow
def test_searches_are_shared_by_threads_that_add_to_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 300 rounds 15 failed once: a dictionary that changes while it is iterated over."""
    monkeypatch.setattr(windows, "Search", lambda *_: object())
    monkeypatch.setattr(windows, "make_lattice", lambda *_: None)
    course, often = SimpleNamespace(robot=None), sys.getswitchinterval()
    stands = [StandingPose((k, k), np.zeros(3)) for k in range(8)]
    sys.setswitchinterval(1e-6)
    try:
        for _ in range(600):
            kept: Searches = {}
            errors = in_two_threads(
                lambda stand, kept=kept: search_between(course, stand, stand, STRICT, 2.0, kept),
                stands,
            )
            assert errors == []
            assert len(kept) == 8
    finally:
        sys.setswitchinterval(often)


def in_two_threads(work: Callable[[StandingPose], object], items: list[StandingPose]) -> list:
    """The errors of work on the halves of `items`, begun at once."""
    errors, together = [], threading.Barrier(2)

    def run(mine: list[StandingPose]) -> None:
        together.wait(10.0)
        try:
            for item in mine:
                work(item)
        except RuntimeError as error:
            errors.append(error)

    both = [threading.Thread(target=run, args=(items[k::2],)) for k in range(2)]
    for thread in both:
        thread.start()
    for thread in both:
        thread.join()
    return errors
