"""What stops the motion between critical poses is judged when it is first needed, and only then."""

from __future__ import annotations

import copy
import json
import pickle
from collections.abc import Callable

import pytest

import stairwright as sw
from stairwright.planning.certificate.joining import motion_problem
from stairwright.planning.plan import Certificate, Plan
from stairwright.planning.problem import Problem

STOP = Problem(kind="clearance", at=(1.0, 0.2), progress=0.5, message="too close")
WAYS: dict[str, Callable[[Certificate], object]] = {
    "read": lambda one: one.motion and one.motion.model_dump(),
    "dump": lambda one: one.model_dump()["motion"],
    "json": lambda one: json.loads(one.model_dump_json())["motion"],
    "pickle": lambda one: pickle.loads(pickle.dumps(one)).model_dump()["motion"],
    "copy": lambda one: copy.deepcopy(one).model_dump()["motion"],
    "fields": lambda one: dict(one)["motion"] and one.model_dump()["motion"],
}


@pytest.fixture
def asked() -> list[int]:
    """One entry for every time that the motion was judged."""
    return []


@pytest.fixture
def certificate(asked: list[int]) -> Certificate:
    def find() -> Problem:
        asked.append(1)
        return STOP

    return Certificate.of_poses([], find)


@pytest.mark.parametrize("way", WAYS)
def test_every_way_to_the_motion_finds_it(certificate: Certificate, way: str) -> None:
    found = WAYS[way](certificate)
    assert found == json.loads(STOP.model_dump_json()) or found == STOP.model_dump()


def test_is_judged_once_and_not_before_it_is_needed(
    certificate: Certificate, asked: list[int]
) -> None:
    assert certificate.passed
    assert certificate.scope == "poses"
    assert not asked
    assert certificate.motion == STOP
    assert list(certificate.model_dump()) == ["passed", "scope", "motion", "checks"]
    assert certificate == Certificate(passed=True, scope="poses", motion=STOP)
    assert len(asked) == 1
    with pytest.raises(AttributeError, match="nothing"):
        _ = certificate.nothing  # type: ignore[attr-defined]


def test_motion_unread_counts_in_comparisons(certificate: Certificate) -> None:
    assert certificate != Certificate(passed=True, scope="poses")
    other = Certificate.of_poses([], lambda: None)
    assert Certificate(passed=True, scope="poses") == other


@pytest.mark.parametrize("terrain", ["single-stair-036", "ramp-30deg-025"])
def test_document_says_what_the_check_of_the_motion_says(terrain: str) -> None:
    plan = sw.plan(terrain, method="critical")
    assert plan.certificate is not None
    again = Plan.model_validate_json(plan.model_dump_json())
    assert again.certificate is not None
    assert again.certificate.motion == plan.certificate.motion == motion_problem(again)
