"""Stairwright: can a wheel-legged robot roll over these stairs, and how?"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .mujoco_library import load_mujoco_library

if TYPE_CHECKING:
    from .client import Client, ServiceError
    from .importing import import_robot, import_terrain
    from .library import load_robot, load_terrain, robots, terrains
    from .planning.certificate.certify import certify
    from .planning.plan import Plan
    from .planning.planner import plan
    from .robot.description import Robot
    from .simulation.margins_result import RobustMargins
    from .simulation.result import Rollout
    from .simulation.robust_margins import robust_margins
    from .simulation.rollout import rollout
    from .simulation.trials import trials
    from .simulation.trials_result import Trials
    from .studies.design import design
    from .studies.design_result import DesignResult
    from .studies.study import StudyResult, study
    from .terrain.profile import Terrain

__version__ = "0.1.0"

__all__ = [
    "Client",
    "DesignResult",
    "Plan",
    "Robot",
    "RobustMargins",
    "Rollout",
    "ServiceError",
    "StudyResult",
    "Terrain",
    "Trials",
    "certify",
    "design",
    "import_robot",
    "import_terrain",
    "load_robot",
    "load_terrain",
    "plan",
    "robots",
    "robust_margins",
    "rollout",
    "study",
    "terrains",
    "trials",
]

load_mujoco_library()  # the native core links it

# Loaded on first use: `stairwright --help` and the web process need neither CasADi nor MuJoCo.
_HOMES = {
    "Client": "client",
    "DesignResult": "studies.design_result",
    "Plan": "planning.plan",
    "Robot": "robot.description",
    "RobustMargins": "simulation.margins_result",
    "Rollout": "simulation.result",
    "ServiceError": "client",
    "StudyResult": "studies.study",
    "Terrain": "terrain.profile",
    "Trials": "simulation.trials_result",
    "certify": "planning.certificate.certify",
    "import_robot": "importing",
    "import_terrain": "importing",
    "design": "studies.design",
    "load_robot": "library",
    "load_terrain": "library",
    "plan": "planning.planner",
    "robots": "library",
    "robust_margins": "simulation.robust_margins",
    "rollout": "simulation.rollout",
    "study": "studies.study",
    "terrains": "library",
    "trials": "simulation.trials",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
