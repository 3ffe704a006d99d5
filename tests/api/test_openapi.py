"""The document that other tools are generated from."""

from __future__ import annotations

import httpx
import pytest

from tests.conftest import Server


@pytest.fixture(scope="module")
def document(server: Server) -> dict[str, dict[str, dict[str, dict[str, object]]]]:
    answer = httpx.get(f"{server.url}/api/v1/openapi.json")
    assert answer.status_code == 200
    return dict(answer.json())


def test_every_route_of_the_contract_is_there(document: dict[str, dict[str, object]]) -> None:
    paths = document["paths"]
    wanted = {
        "/robots": "get",
        "/robots/{name}": "get",
        "/terrains": "get",
        "/terrains/{name}": "get put delete",
        "/terrains/generate": "post",
        "/terrains/import": "post",
        "/settings": "get",
        "/plans": "post",
        "/plans/{plan_id}": "get",
        "/plans/{plan_id}/export": "get",
        "/rollouts": "post",
        "/rollouts/{rollout_id}": "get",
        "/rollouts/{rollout_id}/export": "get",
        "/jobs/{job_id}": "get delete",
        "/jobs/{job_id}/events": "get",
        "/sessions": "post",
        "/sessions/{session_id}": "delete",
        "/sessions/{session_id}/scene": "put",
        "/sessions/{session_id}/playback": "put",
        "/healthz": "get",
    }
    for path, methods in wanted.items():
        assert set(methods.split()) <= set(paths[f"/api/v1{path}"]), path


def test_errors_are_problem_documents(document: dict[str, dict[str, dict[str, object]]]) -> None:
    for path, operations in document["paths"].items():
        for operation in operations.values():
            for status, response in operation["responses"].items():
                if int(status) >= 400:
                    assert list(response["content"]) == ["application/problem+json"], path
    assert "HTTPValidationError" not in document["components"]["schemas"]


def test_questions_come_with_examples(document: dict[str, dict[str, dict[str, object]]]) -> None:
    for name in ("PlanRequest", "RolloutRequest"):
        assert document["components"]["schemas"][name]["examples"]
