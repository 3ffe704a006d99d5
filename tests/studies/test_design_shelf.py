"""Design searches can be looked at while they are at work, over REST too."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import httpx
import pytest

from stairwright.api.app import create_app
from stairwright.api.settings import Settings
from stairwright.studies import design as designing
from stairwright.studies import design_search
from stairwright.studies.design_shelf import RESULT, kept_results, read_result
from tests.in_process import served

from .test_design import Rule, _document


def _search(folder: Path, monkeypatch: pytest.MonkeyPatch, **options: Any) -> Path:
    """A search in the studies' folder, whatever its id is."""
    monkeypatch.setattr(designing, "choose_engine", lambda *_: Rule())
    monkeypatch.setenv("STAIRWRIGHT_DATA", str(folder))
    designing.design(_document(name="small", designs=24), **options)
    return folder / "studies"


@pytest.mark.slow
def test_a_search_at_work_tells_what_it_has_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(design_search, "_TOLD", 0.0)
    seen = []

    def look(done: int, _: int) -> None:
        (only,) = kept_results(tmp_path / "studies")
        seen.append((done, only.tried, only.complete))

    studies = _search(tmp_path, monkeypatch, progress=look)
    assert seen == [(k, k, False) for k in (8, 16, 24)]
    (only,) = kept_results(studies)
    assert (only.tried, only.designs, only.complete) == (24, 24, True)
    assert 0 < only.best <= only.passed < 24


@pytest.mark.slow
def test_what_is_no_result_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    studies = _search(tmp_path, monkeypatch)
    for name, content in (("d-1", b"{"), ("d-2", b"[]"), ("d-3", b'{"id": "d-3"}')):
        (studies / name).mkdir()
        (studies / name / RESULT).write_bytes(content)
    assert [each.name for each in kept_results(studies)] == ["small"]
    assert read_result(studies, "d-0") is None


@pytest.mark.slow
def test_rest_lists_searches_and_gives_the_best_with_their_robots(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _search(tmp_path, monkeypatch)
    with (
        served(create_app(Settings(data=tmp_path))) as (_, port),
        httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1") as api,
    ):
        (only,) = api.get("/designs").json()
        answer = api.get(f"/designs/{only['id']}")
        best = [each for each in answer.json()["candidates"] if each["best"]]
        assert len(best) == only["best"]
        assert all(each["robot"]["name"] == "a1_wheeled" for each in best)
        tag = {"if-none-match": answer.headers["etag"]}
        assert api.get(f"/designs/{only['id']}", headers=tag).status_code == 304
        for other in ("d-0123", "nope", "..%5Cd-0123"):
            assert api.get(f"/designs/{other}").status_code == 404
