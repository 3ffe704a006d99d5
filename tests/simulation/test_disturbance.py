"""Every deviation changes what it says it does, and each seed draws its own."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.simulation.disturbance import Disturbance, parse_disturbance
from stairwright.simulation.ranges import BUNDLES, chosen_ranges, draw
from stairwright.simulation.rollout import rollout
from stairwright.simulation.trials import suspects
from stairwright.simulation.trials_result import Trial
from stairwright.simulation.world import build_world, course_frame, real_terrain

STEP = {"name": "step", "points": [[-0.9, 0.0], [0.0, 0.0], [0.0, 0.06], [0.9, 0.06]]}
VALUES = {
    "friction": -0.1,
    "friction_front": -0.2,
    "friction_rear": -0.2,
    "mass": 0.1,
    "payload": 1.0,
    "com_x": 0.01,
    "com_z": 0.02,
    "height": 0.005,
    "step_height_error": 0.01,
    "face_place_error": 0.01,
    "heading": 0.03,
    "cross_slope": 0.03,
    "x_offset": 0.01,
    "odometry_scale": 0.02,
    "pitch_bias": 0.02,
    "noise": 1.0,
    "delay": 0.004,
    "bandwidth": 40.0,
    "friction_wheels": [0.6, 0.6, 0.3, 0.3],
    "torque_scale": -0.05,
    "stiction": 0.3,
    "rotor_inertia": 0.02,
    "imu": {"gyro_bias": 0.02},
}
OF_THE_SENSORS = ("imu",)  # felt where the robot senses by itself


@pytest.fixture(scope="module")
def plan() -> Plan:
    return sw.plan(STEP, "a1_wheeled", friction=0.6)


@pytest.fixture(scope="module")
def undisturbed(plan: Plan) -> np.ndarray:
    return ending(plan)


def ending(plan: Plan, seed: int = 3, sensing: str = "ideal", **deviation: object) -> np.ndarray:
    """Joints along the way."""
    run = rollout(
        plan,
        disturbance=deviation,
        seed=seed,
        controller={"sensing": sensing},
        record_hz=20.0,
        keep_plan=False,
    )
    return np.asarray(run.series.q)


def differs(a: np.ndarray, b: np.ndarray) -> bool:
    n = min(len(a), len(b))
    return len(a) != len(b) or bool(np.abs(a[:n] - b[:n]).max() > 1e-4)


def test_every_field_is_tried() -> None:
    assert set(VALUES) == set(Disturbance.model_fields)


@pytest.mark.slow
@pytest.mark.parametrize("name", VALUES)
def test_each_deviation_is_felt(plan: Plan, undisturbed: np.ndarray, name: str) -> None:
    if name in OF_THE_SENSORS:
        undisturbed = ending(plan, sensing="robot")
        assert differs(ending(plan, sensing="robot", **{name: VALUES[name]}), undisturbed)
        return
    assert differs(ending(plan, **{name: VALUES[name]}), undisturbed)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["step_height_error", "face_place_error", "noise"])
def test_each_seed_draws_its_own(plan: Plan, name: str) -> None:
    one, again = (ending(plan, seed=3, **{name: VALUES[name]}) for _ in range(2))
    np.testing.assert_array_equal(one, again)
    assert differs(one, ending(plan, seed=4, **{name: VALUES[name]}))


def test_faces_move_and_steps_rise() -> None:
    terrain = sw.load_terrain("three-stairs-up-down")
    deviation = Disturbance(step_height_error=0.01, face_place_error=0.015)
    real = np.array(real_terrain(terrain, deviation, 5).points)
    drawn = np.array(terrain.points)
    moved = real - drawn
    assert 0.0 < np.abs(moved[:, 0]).max() <= 0.03
    rises = np.diff(moved[:, 1])
    assert 0.0 < np.abs(rises).max() <= 0.02 + 1e-12
    faces = np.flatnonzero(np.diff(drawn[:, 0]) == 0.0)
    np.testing.assert_allclose(moved[faces, 0], moved[faces + 1, 0])  # they stay vertical
    treads = np.flatnonzero(np.diff(drawn[:, 1]) == 0.0)
    np.testing.assert_allclose(moved[treads, 1], moved[treads + 1, 1], atol=1e-12)  # and level
    assert np.all(moved[:2, 1] == 0.0)  # heights count from where the robot starts
    assert len({real_terrain(terrain, deviation, seed).points[2] for seed in range(5)}) == 5


def test_errors_are_given_one_by_one_or_drawn_with_a_standard_deviation() -> None:
    terrain = sw.load_terrain("three-stairs-up-down")
    drawn = np.array(terrain.points)
    deviation = Disturbance(step_height_error=[0.01, -0.02], face_place_error=[0.0, 0.015])
    moved = np.array(real_terrain(terrain, deviation, 0).points) - drawn
    np.testing.assert_allclose(np.unique(moved[:, 1].round(9)), [-0.01, 0.0, 0.01])
    np.testing.assert_allclose(np.unique(moved[:, 0].round(9)), [0.0, 0.015])
    heights = [
        np.diff(
            np.array(real_terrain(terrain, Disturbance(step_height_error=0.01), k).points)[:, 1]
        )
        for k in range(200)
    ]
    errors = np.array(heights) - np.diff(drawn[:, 1])
    errors = errors[np.abs(errors) > 1e-12]
    assert errors.std() == pytest.approx(0.01, rel=0.1)


@pytest.mark.parametrize(
    ("value", "field"),
    [
        ({"friction_wheels": [0.6, 0.6, 0.0, 0.6]}, "friction_wheels"),
        ({"payload": {"mass": -1.0}}, "payload"),
        ({"imu": {"gyro": 1.0}}, "imu"),
        ({"torque_scale": 0.95}, "torque_scale"),
        ({"step_height_error": [0.2]}, "step_height_error"),
    ],
)
def test_bad_deviations_are_named(value: dict[str, object], field: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_disturbance(value)
    assert caught.value.field[:2] == ("disturbance", field)


def test_a_payload_has_a_place_and_motors_are_not_as_believed() -> None:
    robot, terrain = sw.load_robot("a1_wheeled"), sw.load_terrain("flat")
    plain = build_world(robot, terrain, 0.6, Disturbance(), pivot=0.0)
    deviation = parse_disturbance(
        {
            "payload": {"mass": 2.0, "place": [0.1, 0.05, 0.1]},
            "friction_wheels": [0.5, 0.6, 0.3, 0.4],
            "stiction": 0.2,
            "rotor_inertia": 0.0,
        }
    )
    model = build_world(robot, terrain, 0.6, deviation, pivot=0.0)
    trunk, before = model.body("trunk"), plain.body("trunk")
    mass = trunk.mass[0]
    assert mass - before.mass[0] == pytest.approx(2.0)
    place = (trunk.ipos * mass - before.ipos * before.mass[0]) / 2.0
    np.testing.assert_allclose(place, [0.1, 0.05, 0.1], atol=1e-9)
    grips = [model.geom(f"{leg}_wheel").friction[0] for leg in ("FL", "RL", "RR")]
    np.testing.assert_allclose(grips, [0.5, 0.3, 0.4])
    assert np.all(model.dof_armature[6:] == 0.0)
    np.testing.assert_allclose(model.dof_frictionloss[6:], plain.dof_frictionloss[6:] + 0.2)


def test_a_payload_without_a_place_lies_on_the_trunks_middle() -> None:
    """Not where most corners of its outline are: a head has many of them."""
    robot, terrain = sw.load_robot("go2w"), sw.load_terrain("flat")
    plain = build_world(robot, terrain, 0.6, Disturbance(), pivot=0.0).body("trunk")
    trunk = build_world(robot, terrain, 0.6, Disturbance(payload=3.0), pivot=0.0).body("trunk")
    place = (trunk.ipos * trunk.mass[0] - plain.ipos * plain.mass[0]) / 3.0
    np.testing.assert_allclose(place, [0.0, 0.0, 0.057 + 0.05], atol=1e-9)


def test_faces_do_not_cross() -> None:
    narrow = sw.Terrain(points=[(-1, 0), (0, 0), (0, 0.1), (0.05, 0.1), (0.05, 0.2), (1, 0.2)])
    for seed in range(20):
        x = np.array(real_terrain(narrow, Disturbance(face_place_error=0.1), seed).points)[:, 0]
        assert np.all(np.diff(x) >= 0.0)


def test_the_world_is_turned_and_the_wheels_grip_differently() -> None:
    robot, terrain = sw.load_robot("a1_wheeled"), sw.load_terrain("single-stair-030")
    deviation = Disturbance(heading=0.1, cross_slope=0.05, friction_rear=-0.2, payload=3.0)
    model = build_world(robot, terrain, 0.6, deviation, pivot=-1.0)
    plain = build_world(robot, terrain, 0.6, Disturbance(), pivot=-1.0)
    frictions = {leg: model.geom(f"{leg}_wheel").friction[0] for leg in ("FL", "RL")}
    assert model.geom("RL_wheel").priority[0] > model.geom("terrain_0").priority[0]
    assert frictions["RL"] == pytest.approx(0.4)
    assert model.geom("FL_wheel").priority[0] == 0
    assert model.body_mass.sum() - plain.body_mass.sum() == pytest.approx(3.0)
    turn, origin = course_frame(deviation, -1.0)
    for name in ("terrain_0", "terrain_1"):
        here, there = model.geom(name), plain.geom(name)
        np.testing.assert_allclose(here.pos, turn @ (there.pos - origin) + origin, atol=1e-12)
        matrix = np.zeros(9)
        mujoco.mju_quat2Mat(matrix, here.quat)
        np.testing.assert_allclose(matrix.reshape(3, 3), turn, atol=1e-12)


def test_bundles_are_known_by_name() -> None:
    assert chosen_ranges(bundle="field") is BUNDLES["field"]
    deviations = draw(BUNDLES["field"], 50, 1)
    assert all(
        d.face_place_error == pytest.approx(0.03 / 3**0.5) and d.delay == 0.008 for d in deviations
    )
    assert max(abs(d.x_offset) for d in deviations) > 0.015
    with pytest.raises(InputError, match="laboratory"):
        chosen_ranges(bundle="moon")


def test_suspects_are_what_failed_trials_had_more_of() -> None:
    def trial(start: float, outcome: str) -> Trial:
        deviation = Disturbance(x_offset=start, com_x=0.01)
        return Trial.model_validate(
            {
                "seed": 0,
                "disturbance": deviation,
                "outcome": outcome,
                "reason": "",
                "pitch_error_max": 0.0,
                "link_contacts": 0,
            }
        )

    rows = [trial(0.001 * k, "success") for k in range(5)]
    rows += [trial(-0.02, "fell"), trial(0.0035, "stuck")]
    assert suspects(rows) == {"x_offset": 0.9}
    assert suspects(rows[:5]) == {}


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"payload": "heavy"}, ("payload",)),
        ({"payload": {"mass": 1.0, "y": 3.0}}, ("payload", "y")),
        ({"step_height_error": [0.01, 5.0]}, ("step_height_error", 1)),
    ],
)
def test_a_bad_value_is_told_once_by_the_place_that_it_has(
    given: dict[str, object], field: tuple[str | int, ...]
) -> None:
    with pytest.raises(InputError) as caught:
        parse_disturbance(given)
    assert caught.value.field == ("disturbance", *field)
