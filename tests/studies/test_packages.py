"""What studies need is installed for the first one; where it cannot be, it says why."""

from __future__ import annotations

import shlex
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest

import stairwright as sw
from stairwright.api.app import create_app
from stairwright.api.settings import Settings
from stairwright.errors import InputError
from stairwright.studies import packages
from tests.in_process import served

from .small import STEP

Serving = Callable[[str], AbstractContextManager[httpx.Client]]


@pytest.fixture
def there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file without which the packages seem to be missing."""
    flag = tmp_path / "installed"
    monkeypatch.setattr(packages, "find_spec", lambda name: flag.exists() or None)
    return flag


@pytest.fixture
def serving(tmp_path_factory: pytest.TempPathFactory, there: Path) -> Serving:
    """A service that installs by a command."""

    @contextmanager
    def serve(command: str) -> Iterator[httpx.Client]:
        data = tmp_path_factory.mktemp("data")
        settings = Settings(data=data, study_workers=1, studies_setup=command)
        with (
            served(create_app(settings)) as (_, port),
            httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1", timeout=30) as api,
        ):
            yield api

    return serve


def _until(api: httpx.Client, name: str, state: str) -> dict[str, Any]:
    while (now := api.get(f"/studies/{name}").json())["state"] != state:
        assert now["state"] in ("queued", "running"), now
        time.sleep(0.05)
    return dict(now)


def test_whoever_asks_without_them_is_told_how_to_install_them(there: Path) -> None:
    for ask in (sw.study, sw.design):
        with pytest.raises(InputError, match=r"\./dev studies.*not there: cryptography, "):
            ask({})


@pytest.mark.slow
def test_the_first_study_installs_them(serving: Serving, there: Path, tmp_path: Path) -> None:
    go = tmp_path / "go"
    wait = f"until [ -e {go} ]; do sleep 0.05; done; echo once >> {there}"
    with serving(shlex.join(["sh", "-c", wait])) as api:
        answer = api.post("/studies", json=STEP)
        assert answer.status_code == 202, answer.text
        name = answer.json()["id"]
        assert _until(api, name, "running")["stage"] == packages.INSTALLING
        assert api.post(f"/studies/{name}/cancel").json()["state"] == "cancelled"
        api.post("/studies", json=STEP)
        _until(api, name, "running")
        go.touch()
        state = _until(api, name, "done")
        assert (state["stage"], state["done"]) == ("", 6)
    assert there.read_text() == "once\n"


@pytest.mark.slow
def test_why_it_cannot_is_told_and_the_next_study_tries_again(
    serving: Serving, tmp_path: Path
) -> None:
    tries = tmp_path / "tries"
    fail = f"import sys; open({str(tries)!r}, 'a').write('x'); sys.exit('first\\n▸ ./dev: offline')"
    with serving(shlex.join([sys.executable, "-c", fail])) as api:
        for count in (1, 2):
            name = api.post("/studies", json=STEP).json()["id"]
            error = _until(api, name, "failed")["error"]
            assert error["status"] == 503
            assert "cannot be installed: ./dev: offline; the next one" in error["detail"]
            assert len(tries.read_text()) == count
    with serving("/no/such/command") as api:
        name = api.post("/studies", json=STEP).json()["id"]
        assert "/no/such/command" in _until(api, name, "failed")["error"]["detail"]
