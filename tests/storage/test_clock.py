"""Computers without a battery for their clock: nothing is lost for what the clock says."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from stairwright.storage import clock
from stairwright.storage.artefacts import Artefacts
from stairwright.storage.clock import ClockWatch, UseClock, doubt
from stairwright.storage.housekeeping import trim_records
from stairwright.storage.idempotency import Verdict
from stairwright.storage.jobs import JobRecord
from stairwright.storage.store import Store

from .test_store import put_document

DAY = 86400.0


@contextmanager
def clock_set(days: float) -> Iterator[None]:
    """The system's clock as a process sees it that starts now."""
    right = time.time
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(time, "time", lambda: right() + days * DAY)
        yield


@pytest.mark.parametrize("days", [100.0, -20000.0])
def test_a_wrong_clock_at_one_start_removes_nothing(tmp_path: Path, days: float) -> None:
    store = Store(tmp_path)
    put_document(store, "p-1", b"{}" * 100)
    store.jobs.put(JobRecord("j-1", "rollout", "done", "/there", None))
    store.idempotency.begin("/rollouts", "k", "body")
    store.idempotency.finish("/rollouts", "k", "j-1")
    store.close()
    with clock_set(days):
        store = Store(tmp_path)
        assert store.collect(keep_bytes=10**9) == 0
        entry = store.documents.get("plan", "p-1")
        assert entry is not None
        assert store.artefacts.content(entry.digest) == b"{}" * 100
        assert store.jobs.get("j-1") is not None
        assert store.idempotency.begin("/rollouts", "k", "body") == (Verdict.SEEN, "j-1")


def test_the_order_of_use_survives_a_clock_that_is_put_right(tmp_path: Path) -> None:
    for days, name in ((100.0, "ahead"), (-20000.0, "in-1970"), (0.0, "right")):
        with clock_set(days):
            store = Store(tmp_path)
            put_document(store, name, os.urandom(1000), question=name)
            store.close()
    store = Store(tmp_path)
    assert store.collect(keep_bytes=2500) == 1
    assert store.documents.get("plan", "ahead") is None  # used first, though its clock said last
    assert store.documents.get("plan", "in-1970") is not None


def test_a_use_clock_only_goes_forward() -> None:
    future = time.time() + 100 * DAY
    uses = UseClock(newest=future)
    one, two = uses.now(), uses.now()
    assert future <= one <= two < future + DAY


def test_only_so_many_records_are_kept(tmp_path: Path) -> None:
    store = Store(tmp_path)
    for k in range(6):
        state = "running" if k == 0 else "done"
        with clock_set(-float(k)):  # the order counts, not what the clock said
            store.jobs.put(JobRecord(f"j-{k}", "rollout", state, None, None))
            store.idempotency.begin("/rollouts", f"k-{k}", "body")
    trim_records(store._sessions, jobs=2, keys=2)
    kept = [k for k in range(6) if store.jobs.get(f"j-{k}")]
    assert kept == [0, 4, 5]  # one that runs stays in any case
    assert store.idempotency.begin("/rollouts", "k-5", "body")[0] is Verdict.BUSY
    assert store.idempotency.begin("/rollouts", "k-3", "body")[0] is Verdict.NEW


def test_files_that_nobody_refers_to_go_at_the_second_look(tmp_path: Path) -> None:
    artefacts = Artefacts(tmp_path)
    wanted, orphan = artefacts.put(b"wanted"), artefacts.put(b"orphan")
    os.utime(tmp_path / orphan[:2] / f"{orphan}.json", (0, 0))  # by a clock in 1970
    assert artefacts.sweep({wanted}, grace=0.01) == 0  # it may have been put this moment
    time.sleep(0.02)
    assert artefacts.sweep({wanted}, grace=0.01) == 1
    assert artefacts.has(wanted)
    assert not artefacts.has(orphan)


def test_an_odd_clock_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    now = time.time()
    assert doubt(None) is None
    assert doubt(now - DAY) is None
    assert "100 days ago" in str(doubt(now - 100 * DAY))
    assert "9 days behind" in str(doubt(now + 9 * DAY))
    watch = ClockWatch()
    assert watch.jump() == 0.0
    monkeypatch.setattr(clock.time, "time", lambda: now + 5 * DAY)
    assert watch.jump() == pytest.approx(5 * DAY, abs=600)
    assert watch.jump() == 0.0
