"""What is saved is there again, whole, after a restart and after being killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from alembic.config import Config
from alembic.script import ScriptDirectory
from sqlalchemy import text

from stairwright.errors import InputError
from stairwright.storage.artefacts import Artefacts
from stairwright.storage.database import MIGRATIONS, newest_revision
from stairwright.storage.idempotency import Verdict
from stairwright.storage.jobs import JobRecord
from stairwright.storage.store import DATABASE, Store
from stairwright.terrain.profile import Terrain

STAIR = Terrain(name="mine", points=[(0, 0), (1, 0), (1, 0.2), (3, 0.2)])


def put_document(store: Store, name: str, content: bytes, question: str = "q") -> None:
    digest = store.artefacts.put(content)
    store.shelve(
        "plan",
        name,
        question=question,
        engine="e",
        digest=digest,
        size=len(content),
        summary={"status": "feasible"},
    )


def test_everything_survives_a_restart(tmp_path: Path) -> None:
    store = Store(tmp_path)
    assert store.terrains.put(STAIR)
    put_document(store, "p-1", b'{"a": 1}')
    store.jobs.put(JobRecord("j-1", "rollout", "done", "/there", None))
    store.close()
    again = Store(tmp_path)
    assert again.terrains.get("mine") == STAIR
    entry = again.documents.get("plan", "p-1")
    assert entry is not None
    assert again.artefacts.content(entry.digest) == b'{"a": 1}'
    assert again.jobs.get("j-1") == JobRecord("j-1", "rollout", "done", "/there", None)


def test_terrains_are_replaced_and_deleted(tmp_path: Path) -> None:
    store = Store(tmp_path)
    assert store.terrains.put(STAIR)
    assert not store.terrains.put(STAIR.model_copy(update={"friction": 0.9}))
    saved = store.terrains.get("mine")
    assert saved is not None
    assert saved.friction == 0.9
    assert store.terrains.delete("mine")
    assert not store.terrains.delete("mine")
    assert store.terrains.names() == []


def test_the_same_question_finds_its_answer_only_while_the_code_is_the_same(
    tmp_path: Path,
) -> None:
    store = Store(tmp_path)
    put_document(store, "p-1", b"{}", question="how?")
    assert store.documents.answer("plan", "how?", "e") is not None
    assert store.documents.answer("plan", "how?", "newer") is None
    assert store.documents.answer("rollout", "how?", "e") is None


def test_a_lost_artefact_is_no_answer(tmp_path: Path) -> None:
    store = Store(tmp_path)
    put_document(store, "p-1", b"{}")
    for path in (tmp_path / "artefacts").glob("*/*"):
        path.unlink()
    assert store.documents.get("plan", "p-1") is None


def test_unfinished_jobs_of_a_dead_process_are_known_with_what_they_ask(tmp_path: Path) -> None:
    jobs = Store(tmp_path).jobs
    for k, (name, state) in enumerate((("j-1", "queued"), ("j-2", "running"), ("j-3", "done"))):
        record = JobRecord(name, "rollout", state, None, None, "key", "me", created=100.0 + k)
        jobs.put(record, {"seed": 7}, "digest")
    jobs = Store(tmp_path).jobs
    assert [job.id for job in jobs.unfinished()] == ["j-2", "j-1"]  # what ran goes first
    assert jobs.unfinished()[0].owner == "me"
    assert jobs.question("key") == {"seed": 7}
    assert jobs.needed() == {"digest"}
    for name in ("j-1", "j-2"):
        jobs.put(JobRecord(name, "rollout", "done", None, None, "key", created=100.0))
    assert jobs.unfinished() == []
    assert jobs.question("key") is None
    assert jobs.needed() == set()


def test_jobs_by_state_newest_first(tmp_path: Path) -> None:
    jobs = Store(tmp_path).jobs
    for k in range(5):
        state = "done" if k % 2 else "failed"
        jobs.put(JobRecord(f"j-{k}", "rollout", state, None, None, created=float(k)))
    found, total = jobs.page(2, 1)
    assert ([job.id for job in found], total) == (["j-3", "j-2"], 5)
    found, total = jobs.page(10, 0, ["done"])
    assert ([job.id for job in found], total) == (["j-3", "j-1"], 2)
    assert jobs.page(10, 0, [], ["plan"]) == ([], 0)


def test_a_deleted_result_goes_with_its_content(tmp_path: Path) -> None:
    store = Store(tmp_path)
    digest, size = store.artefacts.put(b"{}"), 2
    for name in ("p-1", "p-2"):
        store.shelve("plan", name, question=name, engine="e", digest=digest, size=size, summary={})
    assert store.delete("plan", "p-1")
    assert store.artefacts.content(digest) == b"{}"  # the other one refers to it
    assert store.delete("plan", "p-2")
    assert not store.delete("plan", "p-2")
    with pytest.raises(FileNotFoundError):
        store.artefacts.content(digest)


def test_idempotency_keys(tmp_path: Path) -> None:
    keys = Store(tmp_path).idempotency
    assert keys.begin("/plans", "k", "body") == (Verdict.NEW, None)
    assert keys.begin("/plans", "k", "body") == (Verdict.BUSY, None)
    assert keys.begin("/rollouts", "k", "body") == (Verdict.NEW, None)
    keys.finish("/plans", "k", "p-1")
    assert keys.begin("/plans", "k", "body") == (Verdict.SEEN, "p-1")
    assert keys.begin("/plans", "k", "other") == (Verdict.OTHER, None)
    keys.release("/rollouts", "k")
    assert keys.begin("/rollouts", "k", "body") == (Verdict.NEW, None)


def test_what_is_too_much_is_collected_the_least_used_first(tmp_path: Path) -> None:
    store = Store(tmp_path)
    for k in range(5):
        put_document(store, f"p-{k}", os.urandom(1000), question=str(k))
        time.sleep(0.002)
    assert store.collect(keep_bytes=2500) == 3
    left, total = store.documents.page("plan", 10, 0)
    assert [entry.id for entry in left] == ["p-4", "p-3"]
    assert total == 2
    assert len(list((tmp_path / "artefacts").glob("*/*"))) == 2
    assert store.collect(keep_bytes=0) == 2


def test_artefacts_are_written_once_and_whole(tmp_path: Path) -> None:
    artefacts = Artefacts(tmp_path / "a")
    digest = artefacts.put(b"content")
    assert artefacts.put(b"content") == digest
    assert artefacts.unsettled() == [digest]
    packed = artefacts.packed(digest)
    assert artefacts.settle(digest) == len(packed)
    assert artefacts.settle(digest) == len(packed)
    assert artefacts.put(b"content") == digest
    assert artefacts.unsettled() == []
    assert artefacts.packed(digest) == packed
    assert artefacts.content(digest) == b"content"
    assert [path.suffix for path in (tmp_path / "a").glob("*/*")] == [".gz"]
    artefacts.remove(digest)
    assert artefacts.settle(digest) is None
    with pytest.raises(FileNotFoundError):
        artefacts.packed(digest)


def test_an_artefact_cut_short_by_a_power_cut_is_missing(tmp_path: Path) -> None:
    artefacts = Artefacts(tmp_path / "a")
    digest = artefacts.put(b"content")
    (plain,) = (tmp_path / "a").glob("*/*")
    plain.write_bytes(b"cont")
    with pytest.raises(FileNotFoundError):
        artefacts.content(digest)
    assert artefacts.put(b"content") == digest
    assert artefacts.content(digest) == b"content"


def test_what_was_left_unsettled_is_settled_after_a_restart(tmp_path: Path) -> None:
    put_document(Store(tmp_path), "p-1", b"{}" * 500)
    store = Store(tmp_path)
    assert store.settle() == 1
    assert store.settle() == 0
    entry = store.documents.get("plan", "p-1")
    assert entry is not None
    assert entry.size == store.artefacts.path(entry.digest).stat().st_size < 500
    assert store.artefacts.content(entry.digest) == b"{}" * 500


def test_the_database_is_migrated_and_logs_ahead(tmp_path: Path) -> None:
    store = Store(tmp_path)
    with store.engine.connect() as connection:
        assert connection.execute(text("PRAGMA journal_mode")).scalar() == "wal"
        assert connection.execute(text("SELECT version_num FROM alembic_version")).scalar()


def test_files_of_migrations_are_named_by_their_revision() -> None:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    assert ScriptDirectory.from_config(config).get_current_head() == newest_revision()


def test_a_folder_that_cannot_be_used_is_bad_input(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="data folder"):
        Store(tmp_path / "file" / "data")


def test_a_database_of_a_newer_version_is_left_alone(tmp_path: Path) -> None:
    store = Store(tmp_path)
    with store.engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    store.close()
    with pytest.raises(InputError, match="newer Stairwright"):
        Store(tmp_path)
    assert not list(tmp_path.glob("*.damaged-*"))


WRITER = """
import sys
from pathlib import Path
from stairwright.storage.store import Store
from stairwright.terrain.profile import Terrain
store = Store(Path(sys.argv[1]))
k = int(sys.argv[2])
while True:
    name = f"t{k}"
    store.terrains.put(Terrain(name=name, points=[(0, 0), (1 + k * 1e-3, 0)]))
    digest = store.artefacts.put(f'{{"k": {k}}}'.encode() * 200)
    store.shelve("plan", f"p-{k}", question=str(k), engine="e", digest=digest, size=9, summary={})
    if k % 3 == 0:
        store.settle()
    print(k, flush=True)
    k += 1
"""


@pytest.mark.slow
def test_nothing_acknowledged_is_lost_to_kill_9(tmp_path: Path) -> None:
    told: set[int] = set()
    following = 0
    for round_ in range(2):
        command = [sys.executable, "-c", WRITER, str(tmp_path), str(following)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        assert process.stdout is not None
        while len(told) < 10 * (round_ + 1):
            told.add(int(process.stdout.readline()))
        process.send_signal(signal.SIGKILL)
        told |= {int(line) for line in process.stdout.read().split() if line}
        process.wait()
        following = max(told) + 1
    store = Store(tmp_path)
    with store.engine.connect() as connection:
        assert connection.execute(text("PRAGMA integrity_check")).scalar() == "ok"
    for k in told:
        assert store.terrains.get(f"t{k}") is not None
        entry = store.documents.get("plan", f"p-{k}")
        assert entry is not None
        assert store.artefacts.content(entry.digest) == f'{{"k": {k}}}'.encode() * 200
    assert (tmp_path / DATABASE).is_file()
