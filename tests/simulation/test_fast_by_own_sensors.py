"""Fast plans, carried out by a robot that has only its own sensors."""

import pytest

import stairwright as sw
from stairwright.simulation.ranges import BUNDLES, draw
from stairwright.terrain.stairs import stair


@pytest.fixture(scope="module", params=["up", "down"])
def plan(request: pytest.FixtureRequest) -> sw.Plan:
    """The mass centre has 7 to 14 mm of margin there."""
    flight = stair(0.18, 0.28, 5, direction=request.param, approach=1.18, platform=1.18)
    return sw.plan(flight, "a1_wheeled", 0.6, timing="fast")


@pytest.mark.slow
def test_wheels_that_hop_off_a_riser_do_not_stop_it(plan: sw.Plan) -> None:
    """Nothing deviates; a wheel that meets a riser at 0.4 m/s is in the air for a moment."""
    down = plan.poses[-1].z_c < plan.poses[0].z_c
    assert plan.facing == ("backward" if down else "forward")
    run = sw.rollout(plan, controller={"sensing": "robot"})
    assert run.outcome == "success", run.reason
    assert run.metrics.speed_stairs > 0.3
    ideal = sw.rollout(plan, controller={"sensing": "ideal"})
    assert run.metrics.speed_stairs > 0.9 * ideal.metrics.speed_stairs


@pytest.mark.slow
def test_steps_that_are_off_do_not_stop_it_in_the_middle(plan: sw.Plan) -> None:
    """It finds treads 6 to 15 mm off and goes on, for a plan in motion cannot stand anywhere."""
    deviation = draw(BUNDLES["laboratory"], 1, 2)[0]
    run = sw.rollout(plan, controller={"sensing": "robot"}, disturbance=deviation, seed=2)
    assert run.outcome == "success", run.reason


def down(robot: str, height: float, friction: float) -> sw.Plan:
    wall = sw.Terrain(points=[(-1.0, height), (1.5, height), (1.5, 0.0), (3.0, 0.0)])
    return sw.plan(wall, robot, friction, timing="fast", diagnose=False)


@pytest.mark.slow
@pytest.mark.parametrize("height", [0.6, 0.65])
def test_what_moves_a_leg_is_not_taken_for_the_ground(height: float) -> None:
    """Rear wheels that stop at the edge would seem to be farther, and a calf touch it."""
    plan = down("a1_wheeled", height, 0.5)
    for seed in (0, 1):
        run = sw.rollout(plan, seed=seed)
        assert run.outcome == "success", run.reason


@pytest.mark.slow
def test_a_wheel_that_leans_on_a_wall_a_little_tells_the_place_on_the_way_down() -> None:
    run = sw.rollout(down("go2w", 0.86, 0.3))
    assert run.outcome == "success", run.reason


@pytest.mark.slow
def test_wheels_whose_motors_have_little_left_meet_risers_gently() -> None:
    """Met at full speed, front wheels on the edge above stall, and it slides off."""
    plan = sw.plan(stair(0.67, 0.406, 3), "b2w", 0.65, timing="fast", diagnose=False)
    run = sw.rollout(plan, controller={"sensing": "ideal"})
    assert run.outcome == "success", run.reason


TRENCH = [
    (-1.6, 0.0), (0.0, 0.0), (0.0, -0.07), (0.1, -0.07), (0.1, -0.11), (0.55, -0.11),
    (0.55, -0.41), (1.08, -0.33), (1.08, -0.08), (1.94, -0.08), (1.97, -0.18), (4.0, -0.18),
]  # fmt: skip
HILL = [
    (-1.6, 0.0), (0.0, 0.0), (0.4075, 0.2171), (0.7904, 0.2171), (0.7904, -0.0181),
    (0.9368, -0.0181), (0.9368, -0.4509), (1.1985, -0.4509), (1.1985, -0.8033), (3.0, -0.8033),
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    ("points", "robot", "friction"), [(TRENCH, "a1_wheeled", 0.92), (HILL, "m20", 0.319)]
)
def test_a_wheel_that_has_come_down_fast_is_on_its_tread(
    points: list[tuple[float, float]], robot: str, friction: float
) -> None:
    """Some centimetres before the next edge; its velocity, smoothed, is still that of the fall."""
    plan = sw.plan({"points": points}, robot, friction, timing="fast", diagnose=False)
    for seed in (0, 1):
        run = sw.rollout(plan, seed=seed)
        assert run.outcome == "success", run.reason


@pytest.mark.slow
def test_wheels_that_push_a_wall_a_little_as_they_climb_tell_the_place() -> None:
    """Rear ones, by 6 % of the weight, at 0.6 m/s; front ones on the edge above slip meanwhile."""
    wall = sw.Terrain(points=[(-1.5, 0.0), (0.0, 0.0), (0.0, 0.882), (3.0, 0.882)])
    plan = sw.plan(wall, "a1_wheeled_x", 0.3, timing="fast", diagnose=False)
    for seed in (0, 1):
        run = sw.rollout(plan, seed=seed)
        assert run.outcome == "success", run.reason


@pytest.mark.slow
def test_front_wheels_thrown_off_a_wall_come_back_to_it() -> None:
    """Its mass centre is 2 cm ahead of where it tips backward there."""
    ground = [
        (-1.6, 0.0), (0.0, 0.0), (0.1143, -0.0363), (0.5055, -0.0735), (0.9461, -0.0187),
        (1.1272, -0.0672), (1.3906, 0.005), (1.7686, 0.0503), (2.2053, -0.0373), (2.5704, 0.0653),
        (2.6896, 0.0243), (3.1123, -0.1083), (3.1123, -0.0216), (3.9645, 0.1984), (3.9645, 0.4311),
        (4.1538, 0.4311), (4.2146, 0.7597), (4.5501, 0.7597), (4.5501, 0.6278), (4.6961, 0.6278),
        (6.2961, 0.6278),
    ]  # fmt: skip
    weights = {"pitch": 0.336}
    plan = sw.plan({"points": ground}, "d1", 0.504, weights=weights, timing="fast", diagnose=False)
    for seed in (1, 2):
        run = sw.rollout(plan, seed=seed)
        assert run.outcome == "success", run.reason
