"""Runs parts of the product on the core built with sanitizers: `under_sanitizers.py CORE PART`.

`test_sanitizers.py` starts it. A sanitizer that finds something ends the process.
"""

from __future__ import annotations

import faulthandler
import importlib.util
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import stairwright as sw
from stairwright.errors import InputError

ROOT = Path(__file__).parents[2]
REFUSED = (ValueError, TypeError, IndexError, InputError, MemoryError)
LONGEST = 240.0  # s that one line may take
FRICTION = (1e-6, 0.05, 0.6, 5.0)
HURRIED = {"speed": 1.0}  # what follows a plan is the same at any speed
# Their rollouts succeed like any other's, and are dear here.
EASY = {"flat trunk", "wheels larger than itself", "any thigh", "knees opposed"}


def use(core: Path) -> None:
    """Make `core` the package's native module."""
    name = "stairwright._core"
    if name in sys.modules:
        raise RuntimeError(f"{name} was loaded before the one to test")
    spec = importlib.util.spec_from_file_location(name, core)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    vars(sw)["_core"] = module


def planned(terrain: Any, robot: Any, critical: float = 0.6, **options: bool) -> list[sw.Plan]:
    """By every method; `critical` is the friction of that one."""
    methods = {"path": 0.6, "critical": critical, "nominal": 0.6}
    return [sw.plan(terrain, robot, mu, method, **options) for method, mu in methods.items()]


def drawn() -> Iterator[str]:
    """Profiles like those that people draw, and rollouts of the path and another plan of each."""
    from tests.planning.drawn import random_profile

    for k, seed in enumerate((6, 11)):  # those that are soon driven, one of each A1
        name = ("a1_wheeled", "a1_wheeled_x")[seed % 2]
        plans = planned(random_profile(seed), name)
        ends = [
            sw.rollout(plan, seed=seed, friction=friction, controller=HURRIED).outcome
            for plan, friction in ((plans[0], FRICTION[k]), (plans[1 + k], FRICTION[2 + k]))
        ]
        yield f"{seed}: {[plan.status for plan in plans]} {ends}"


def terrains() -> Iterator[str]:
    """Profiles that nobody builds."""
    from tests.native import hostile

    for k, (name, points) in enumerate(hostile.terrains().items()):
        robot = ("a1_wheeled", "a1_wheeled_x")[k % 2]
        # What would open these takes longer than all the others, and runs what a cliff does.
        diagnose = not name.startswith(("pit", "wall"))
        plans = planned({"points": points}, robot, FRICTION[k % 4], diagnose=diagnose)
        yield f"{name}: {[plan.status for plan in plans]}"


def robots() -> Iterator[str]:
    """Robots that nobody builds, on a step or a slope; some are driven, too."""
    from tests.native import hostile
    from tests.robot.random_robots import random_robot

    step = {"points": [(-0.6, 0), (0, 0), (0, 0.1), (0.6, 0.1)]}
    slope = {"points": [(-0.6, 0), (0, 0), (0.3, 0.1), (0.8, 0.1)]}
    unlike = {f"random {seed}": random_robot(seed) for seed in range(2)}
    for k, (name, robot) in enumerate((hostile.robots() | unlike).items()):
        ground = (step, slope)[k % 2]
        plans = planned(ground, robot)
        driven = [plan for plan in plans if plan.executable and name not in EASY][:1]
        outcomes = [sw.rollout(plan, controller=HURRIED).outcome for plan in driven]
        yield f"{name}: {[plan.status for plan in plans]} {outcomes}"


def wrecks() -> Iterator[str]:
    """Plans of poses that no planner makes, carried out: the simulator's state may be anything."""
    plan = sw.plan("single-stair-030", "a1_wheeled", method="critical").model_dump()
    random = np.random.default_rng(3)
    for k in range(6):
        wreck = {**plan, "poses": [dict(pose) for pose in plan["poses"]]}
        for pose in wreck["poses"]:
            size = 10.0 ** random.uniform(-2, (3, 8, 300)[k % 3])
            pose["q"] = (np.array(pose["q"]) + random.normal(0, size, 4)).tolist()
            pose["wheel_progress"] = random.normal(0, size, 2).tolist()
            pose["pitch"], pose["x_c"], pose["z_c"] = random.normal(0, size, 3).tolist()
            pose["com"] = random.normal(0, size, 2).tolist()
        try:
            outcome: object = sw.rollout(wreck, controller={"speed": 1.0}).outcome
        except REFUSED as error:
            outcome = error
        yield f"{k}: {outcome}"


DRAWN = ("terrain", "wheel path")  # odd points are no ground


def calls() -> Iterator[str]:
    """Native functions asked directly, with numbers that Python's layer may not stop."""
    from stairwright import _core
    from stairwright.control.native import native_controller
    from stairwright.control.setpoint import WIDTH
    from stairwright.control.settings import ControllerSettings
    from stairwright.planning.certificate.shape import shape_of
    from stairwright.planning.poses.pose_search import pose_problem
    from stairwright.terrain.wheel_path import wheel_path
    from tests.native import hostile

    random = np.random.default_rng(11)
    robot, terrain = sw.load_robot("a1_wheeled"), sw.load_terrain("three-stairs-up-down")
    path = wheel_path(terrain, robot.wheel.radius)
    ground, curve = _core.Terrain(path.vertices), path.native
    problem = pose_problem(robot, path)

    def odd(*shape: int) -> Any:
        return hostile.numbers(random, shape)

    def controller() -> None:
        friction = float(odd(1)[0])
        control = native_controller(robot, path, friction, ControllerSettings())
        for _ in range(4):
            control.step(odd(19), odd(18), odd(WIDTH))

    def follower() -> None:
        start, step, lead, dt = odd(4)
        follow = _core.PlanFollower(start, step, odd(5, WIDTH), odd(5), lead)
        for _ in range(4):
            follow.advance(odd(4), True, dt)

    def certificate() -> None:
        ground = _core.CertificateGround(odd(8, 2))
        postures = _core.CertificatePostures(shape_of(robot), odd(12, 3), odd(12, 4))
        postures.trunk(ground, odd(12)), postures.links(ground, odd(12)), postures.rims(0, ground)
        postures.between_legs(), postures.joints(), postures.com(), postures.way()
        points, normals, distances = ground.faces(odd(24, 2), odd(1)[0])
        _core.certificate_balanced(points, normals, distances < 1.0, odd(12), odd(1)[0])

    def uneven() -> None:
        machine = hostile.uneven_robot(random)
        _core.least_clearance(ground, machine, random.normal(0, 1, 3), random.normal(0, 1, 4))
        _core.legs_distance(machine, odd(3), odd(4))
        model = _core.RobotModel(machine)
        weights = _core.PathWeights(1.0, 0.1, 0.1, 1.0, 0.1)
        refining = _core.RefineProblem(ground, curve, model, 0.6, 0.05, 0.01, 0.3, weights)
        poses = np.cumsum(random.uniform(0, 0.03, (30, 5)), axis=0)
        poses += np.array([0.5, 0.1, 0.5, 0.3, 0.0])
        refining.refine(poses[[0, -1]], poses, _core.NodeSpacing(0.5, 0.02, 0.1), 1, odd(3, 2))
        refining.margins(odd(10, 5)), refining.cost(odd(10, 5))
        own = _core.PoseProblem(ground, curve, machine, odd(9, 2), [0.5, 1.0], [0.5])
        own.reference_posture(float(random.normal())), own.pose_records(0.6, odd(6, 5), odd(6, 4))

    def task(exact: bool = True) -> _core.PoseTask:
        bounds = np.sort(random.normal(0, 3, (2, 9)), axis=0)
        return _core.PoseTask(
            odd(7), abs(odd(7)), *bounds, 0.01, 0.01, 0.05, exact, tuple(odd(2).tolist())
        )

    def near() -> Any:
        """Trunk and arc lengths of a pose whose legs about reach their wheels."""
        s = random.uniform(0.5, 2.5) + np.array([0.0, -0.25])
        x, z = curve.sample(s)[:, :2].mean(axis=0)
        return np.array([x, z + random.uniform(0.2, 0.3), random.normal(0.0, 0.1), *s])

    asked: dict[str, Callable[[], object]] = {
        "terrain": lambda: _core.Terrain(odd(8, 2)),
        "wheel path": lambda: _core.WheelPath(odd(8, 2), abs(odd(1)[0])),
        "height": lambda: ground.height(odd(1)[0]),
        "distance": lambda: ground.distance(*odd(3)),
        "link clearance": lambda: ground.link_clearance(*odd(6)),
        "polygon": lambda: ground.polygon_clearance(_core.Polygon(odd(5, 2)), *odd(4)),
        "sample": lambda: curve.sample(odd(9)),
        "project": lambda: curve.project(*odd(4)),
        "obstacles": lambda: _core.find_obstacles(curve, *odd(2)),
        "intervals": lambda: _core.com_intervals(curve, odd(9, 2), odd(1)[0]),
        "firm margins": lambda: _core.firm_com_margins(curve, odd(9, 2), odd(9), 0.6),
        "interval": lambda: _core.com_interval(odd(2, 2), odd(2, 2), odd(1)[0]),
        "least friction": lambda: _core.least_friction(odd(2, 2), odd(2, 2), odd(1)[0]),
        "static forces": lambda: _core.static_forces(curve, *odd(2), odd(6, 2), odd(6, 2)),
        "resting forces": lambda: _core.resting_forces(odd(4), odd(4, 2, 2), odd(4, 2, 2)),
        "contact changes": lambda: _core.contact_changes(curve, odd(9, 5)),
        "balance": lambda: _core.balance_forces(odd(8, 8), odd(8), odd(4), odd(1)[0], odd(8)),
        "quadratic program": lambda: _core.solve_quadratic_program(
            odd(5, 5), odd(5), odd(7, 5), odd(7)
        ),
        "banded": lambda: _core.solve_banded(odd(6, 7), odd(6)),
        "evenness": lambda: _core.Evenness(*odd(3)).cost(odd(6, 3)),
        "rear places": lambda: _core.rear_places(
            curve, *odd(2), tuple(odd(2)), tuple(odd(2)), *odd(4), True
        ),
        "rests": lambda: (_core.rests(curve, *odd(3)), _core.steep_ahead(curve, *odd(3))),
        "pose": lambda: problem.solve(task(), odd(5)),
        "constraints": lambda: problem.constraints(task(), near()),
        "pose records": lambda: problem.pose_records(0.6, odd(4, 5), odd(4, 4)),
        "posture": lambda: problem.reference_posture(odd(1)[0]),
        "certificate": certificate,
        "limits": lambda: _core.limit_torques(robot.native, odd(12), odd(12)),
        "controller": controller,
        "follower": follower,
        "uneven robot": uneven,
    }
    for name, ask in asked.items():
        refused, times = 0, 3 if ask is uneven else 60
        for _ in range(times):
            try:
                ask()
            except REFUSED:
                refused += 1
        assert refused < times or name in DRAWN, f"{name} answers nothing"
        yield f"{name}: {refused} refused"


PARTS: dict[str, Callable[[], Iterator[str]]] = {
    part.__name__: part for part in (drawn, terrains, robots, wrecks, calls)
}

if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    use(Path(sys.argv[1]))
    begun = time.monotonic()
    faulthandler.dump_traceback_later(LONGEST, exit=True)
    for line in PARTS[sys.argv[2]]():
        print(f"{time.monotonic() - begun:6.1f} s  {line}", flush=True)
        faulthandler.dump_traceback_later(LONGEST, exit=True)
    print(f"{sys.argv[2]}: all done", flush=True)
