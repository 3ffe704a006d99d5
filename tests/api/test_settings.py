"""Settings come from the environment, and the document lists every one of them."""

from __future__ import annotations

from dataclasses import MISSING, fields
from pathlib import Path

import pytest

from stairwright.api.settings import Settings
from stairwright.errors import InputError

DOCUMENT = Path(__file__).resolve().parents[2] / "docs" / "service.md"
COMPUTED = {
    "data": "the platform's data folder",
    "page": "the built page",
    "plan_workers": "cores, at most 4",
    "rollout_workers": "cores - 1, at least 1",
    "study_workers": "cores",
}


def table() -> str:
    """The document's table, written from the class."""
    lines = ["| variable | meaning | default |", "|---|---|---|"]
    for each in fields(Settings):
        default = COMPUTED.get(each.name)
        if default is None:
            assert each.default is not MISSING
            default = f"`{each.default}`" if each.default != "" else "none"
        name = f"STAIRWRIGHT_{each.name.upper()}"
        lines.append(f"| `{name}` | {each.metadata['text']} | {default} |")
    return "\n".join(lines)


def test_the_document_lists_every_setting() -> None:
    assert table() in DOCUMENT.read_text(encoding="utf-8")


def test_the_environment_is_read_and_checked() -> None:
    settings = Settings.from_env({"STAIRWRIGHT_PORT": "81", "STAIRWRIGHT_PLAN_DEADLINE": "2.5"})
    assert (settings.port, settings.plan_deadline) == (81, 2.5)
    assert Settings.from_env({"STAIRWRIGHT_PORT": "81"}, port=82).port == 82
    for name, value in (
        ("PORT", "many"),
        ("PORT", "70000"),
        ("PLAN_WORKERS", "0"),
        ("PLAN_DEADLINE", "nan"),
        ("TOKEN", "short"),
        ("LOG_LEVEL", "loud"),
        ("HOST", "0.0.0.0"),
    ):
        with pytest.raises(InputError):
            Settings.from_env({f"STAIRWRIGHT_{name}": value})
