"""The document that other tools are generated from."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

import stairwright
from tests.conftest import Server

PACKAGE = Path(stairwright.__file__).parent


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
        "/terrains/import/heights": "post",
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


def operations(document: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for each in document["paths"].values():
        yield from each.items()


def test_operations_have_names_fit_to_call(document: dict[str, Any]) -> None:
    called = [operation["operationId"] for _, operation in operations(document)]
    assert len(set(called)) == len(called)
    for name in called:
        assert re.fullmatch(
            r"(cancel|create|delete|export|follow|generate|get|import|list|save|set)_[a-z]+(_[a-z]+)?",
            name,
        )
    assert {"create_plan", "create_rollout", "get_job", "import_terrain"} <= set(called)


def test_a_rollout_has_a_schema_of_its_own(document: dict[str, Any]) -> None:
    answer = document["paths"]["/api/v1/rollouts/{rollout_id}"]["get"]["responses"]["200"]
    reference = {"$ref": "#/components/schemas/Rollout"}
    assert answer["content"]["application/json"]["schema"] == reference
    schemas = document["components"]["schemas"]
    angles = schemas["Series"]["properties"]["q"]["items"]
    assert angles == {
        "type": "array",
        "items": {"type": "number"},
        "minItems": 12,
        "maxItems": 12,
    }


def test_an_upload_is_bytes(document: dict[str, Any]) -> None:
    schemas = document["components"]["schemas"]
    assert schemas["Body_import_terrain"]["properties"]["file"]["format"] == "binary"


def test_every_kind_of_problem_is_declared(document: dict[str, Any]) -> None:
    schema = document["components"]["schemas"]["ProblemDocument"]
    declared = set(schema["properties"]["type"]["x-extensible-enum"])
    sources = [path.read_text() for part in ("api", "jobs") for path in (PACKAGE / part).rglob("*")
               if path.suffix == ".py"]  # fmt: skip
    raised = {
        kind
        for text in sources
        for kind in re.findall(r'Problem\((?:[^()]|\([^()]*\))*?kind="([\w-]+)"', text)
        + re.findall(r'^    kind = "([\w-]+)"', text, re.MULTILINE)
    }
    assert {"token", "queue-full", "host"} <= raised
    assert {f"urn:stairwright:problem:{kind}" for kind in raised} <= declared


def test_answers_have_the_headers_that_are_declared(
    server: Server, document: dict[str, Any]
) -> None:
    asked = {
        "/robots": httpx.get(f"{server.url}/api/v1/robots"),
        "/plans": httpx.post(
            f"{server.url}/api/v1/plans",
            json={"terrain": "single-stair-030", "method": "critical"},
        ),
        "/terrains/generate": httpx.post(
            f"{server.url}/api/v1/terrains/generate", json={"kind": "flat"}
        ),
    }
    plan = asked["/plans"].json()["id"]
    asked["/plans/{plan_id}"] = httpx.get(f"{server.url}/api/v1/plans/{plan}")
    asked["/plans/{plan_id}/export"] = httpx.get(f"{server.url}/api/v1/plans/{plan}/export")
    later = {"link"}  # only where there is another page
    common = {"etag", "location", "content-location", "content-disposition", "x-total-count"}
    for path, answer in asked.items():
        method = answer.request.method.lower()
        response = document["paths"][f"/api/v1{path}"][method]["responses"]["200"]
        declared = {name.lower() for name in response.get("headers", {})}
        assert declared - later == common & set(answer.headers), path
    for _, operation in operations(document):
        for status in ("429", "503"):
            if status in operation["responses"]:
                assert "Retry-After" in operation["responses"][status]["headers"]
