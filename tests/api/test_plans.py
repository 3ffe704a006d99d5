"""Plans over REST: real planner, real workers."""

from __future__ import annotations

import httpx
import pytest

import stairwright as sw

CURB = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
WALL = {"points": [[-1.0, 0], [0, 0], [0, 1.3], [1, 1.3]]}


def test_a_plan_is_solved_stored_and_found_again(api: httpx.Client) -> None:
    first = api.post("/plans", json={"terrain": CURB, "robot": "a1_wheeled"})
    assert first.status_code == 200, first.text
    plan = first.json()
    assert plan["schema"] == "stairwright/plan/1"
    assert plan["status"] == "feasible"
    assert len(plan["poses"]) > 10
    again = api.post("/plans", json={"terrain": CURB, "robot": "a1_wheeled"})
    assert again.json() == plan  # solve_time and all: it was not solved again
    stored = api.get(f"/plans/{plan['id']}")
    assert stored.json() == plan
    tag = stored.headers["etag"]
    same = api.get(f"/plans/{plan['id']}", headers={"if-none-match": tag})
    assert same.status_code == 304
    assert plan["id"] in [each["id"] for each in api.get("/plans").json()]


def test_plans_of_documents_that_differ_in_texts_are_kept_apart(api: httpx.Client) -> None:
    robot = sw.load_robot("a1_wheeled").model_dump(mode="json")
    questions = [
        {"terrain": CURB | {"name": "Alice"}, "robot": robot},
        {"terrain": CURB | {"name": "Bob"}, "robot": robot},
        {"terrain": CURB | {"name": "Bob", "description": "a curb"}, "robot": robot},
        {"terrain": CURB | {"name": "Bob"}, "robot": robot | {"description": "mine"}},
    ]
    plans = [api.post("/plans", json=question).json() for question in questions]
    assert len({plan["id"] for plan in plans}) == len(plans)
    assert len({plan["terrain_hash"] for plan in plans}) == 1  # of what planning depends on
    assert len({plan["robot_hash"] for plan in plans}) == 1
    for plan in plans:
        assert api.get(f"/plans/{plan['id']}").json() == plan


def test_a_terrain_by_its_measures_is_the_generated_one(api: httpx.Client) -> None:
    measures = {"kind": "stair", "rise": 0.05, "count": 2}
    generated = api.post("/terrains/generate", json=measures).json()
    plan = api.post("/plans", json={"terrain": measures}).json()
    assert plan["terrain"] == generated
    assert plan["id"] == api.post("/plans", json={"terrain": generated}).json()["id"]


def test_robots_that_cannot_be_simulated_are_refused(api: httpx.Client) -> None:
    robot = sw.load_robot("a1_wheeled").model_dump(mode="json")
    robot["trunk"]["inertia"] = [1.0, 1.0, 100.0]
    answer = api.post("/plans", json={"terrain": CURB, "robot": robot})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == "robot.trunk.inertia"


def test_compressed_or_not_it_is_the_same_plan(api: httpx.Client) -> None:
    question = {"terrain": CURB, "robot": "a1_wheeled"}
    plain = api.post("/plans", json=question, headers={"accept-encoding": "identity"})
    packed = api.post("/plans", json=question, headers={"accept-encoding": "gzip"})
    assert "content-encoding" not in plain.headers
    assert packed.headers["content-encoding"] == "gzip"
    assert plain.json() == packed.json()


@pytest.mark.slow
def test_what_cannot_be_climbed_is_a_plan_with_a_problem(api: httpx.Client) -> None:
    answer = api.post("/plans", json={"terrain": WALL, "method": "path"})
    assert answer.status_code == 200, answer.text
    plan = answer.json()
    assert plan["status"] == "infeasible"
    assert plan["problem"]["message"]
    assert len(plan["problem"]["at"]) == 2


@pytest.mark.parametrize("method", ["path", "critical", "nominal"])
@pytest.mark.parametrize("robot", ["a1_wheeled", "a1_wheeled_x"])
def test_every_method_with_every_robot(api: httpx.Client, method: str, robot: str) -> None:
    body = {"terrain": CURB, "robot": robot, "method": method, "friction": 0.7}
    answer = api.post("/plans", json=body)
    assert answer.status_code == 200, answer.text
    assert answer.json()["method"] == method
    assert answer.json()["friction"] == 0.7


@pytest.mark.parametrize(
    ("body", "field"),
    [
        ({}, "terrain"),
        ({"terrain": "nowhere"}, "terrain"),
        ({"terrain": "../../etc/passwd"}, "terrain"),
        ({"terrain": "pyproject.toml"}, "terrain"),
        ({"terrain": "/etc/passwd.yaml"}, "terrain"),
        ({"terrain": {"points": [[0, 0], [1, 0], [0.5, 1]]}}, "terrain.points.2"),
        ({"terrain": {"points": [[0, 0], [1, "a"]]}}, "terrain.points.1.1"),
        ({"terrain": {"points": [[0, 0], [1, 0]], "colour": 1}}, "terrain.colour"),
        ({"terrain": CURB, "robot": "nobody"}, "robot"),
        ({"terrain": CURB, "robot": {"name": "x"}}, "robot.nominal_height"),
        ({"terrain": CURB, "friction": 0}, "friction"),
        ({"terrain": CURB, "friction": True}, "friction"),
        ({"terrain": CURB, "method": "magic"}, "method"),
        ({"terrain": CURB, "weights": {"beauty": 1}}, "weights.beauty"),
        ({"terrain": CURB, "weights": {"speed": 1e6}}, "weights.speed"),
        ({"terrain": CURB, "weights": {"speed": "slow"}}, "weights.speed"),
        ({"terrain": 5}, "terrain"),
        ({"terrain": {"kind": ["hill"]}}, "terrain"),
        ({"terrain": {"kind": "stair"}}, "terrain.rise"),
        ({"terrain": {"kind": "stair", "rise": 1, "count": 200}}, "terrain.count"),
        ({"terrain": CURB, "wieghts": {}}, "wieghts"),
    ],
)
def test_each_bad_value_is_named(api: httpx.Client, body: dict[str, object], field: str) -> None:
    answer = api.post("/plans", json=body)
    assert answer.status_code == 422, answer.text
    problem = answer.json()
    assert problem["status"] == 422
    assert problem["errors"][0]["field"] == field
    assert problem["errors"][0]["message"]


def test_misspelt_fields_and_unknown_ids_are_told_in_words(api: httpx.Client) -> None:
    misspelt = api.post("/plans", json={"terain": {"point": []}, "robot": "a1_wheeled"}).json()
    assert misspelt["errors"][0]["message"] == "unknown field; did you mean 'terrain'?"
    inner = api.post("/plans", json={"terrain": CURB, "tolerance": {"width": 1}}).json()
    assert inner["errors"][0]["message"] == "unknown field; there are: height, place, friction"
    other = api.post("/plans", json={"terrain": {"schema": "stairwright/robot/2", "name": "x"}})
    assert other.json()["detail"].endswith("this is a robot (stairwright/robot/2), not a terrain")
    for path, told in {
        "/trials/x": "there are no trials with the id 'x'",
        "/rollouts/x": "there is no rollout with the id 'x'",
        "/robots/x": "there is no robot with the name 'x'",
    }.items():
        assert api.get(path).json()["detail"] == told


def test_null_is_the_default_as_in_python(api: httpx.Client) -> None:
    nothing = {"friction": None, "weights": None}
    plans = [api.post("/plans", json={"terrain": CURB, **given}) for given in ({}, nothing)]
    assert plans[0].json()["id"] == plans[1].json()["id"]
    for controller in (None, {"speed": None}):
        body = {"terrain": CURB, "controller": controller, **nothing}
        assert api.post("/rollouts", json=body).status_code == 202
