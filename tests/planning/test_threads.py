"""Work that is asked at once: answers in order, and no work for answers that nobody takes."""

import threading

import pytest

from stairwright.planning.threads import Abandoned, race, search_threads, still_wanted


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
