"""CSV: one row a pose or a sample, one header row with units in the names, nothing else.

The last column, ``source``, names the plan and the hashes of terrain and robot.
"""

from __future__ import annotations

import csv
import io

from stairwright.arrays import Floats
from stairwright.planning.plan import Plan
from stairwright.simulation.result import Rollout

from .columns import PLAN_COLUMNS, ROLLOUT_COLUMNS, plan_arrays, rollout_arrays, table


def plan_csv(plan: Plan) -> bytes:
    """The poses; `key` is 1 for the key poses."""
    header, rows = table(plan_arrays(plan), PLAN_COLUMNS)
    keys = set(plan.critical)
    flags = [str(int(i in keys)) for i in range(len(rows))]
    return _text(header, rows, {"key": flags}, _source(plan.id, plan.terrain_hash, plan.robot_hash))


def rollout_csv(rollout: Rollout) -> bytes:
    """The series."""
    header, rows = table(rollout_arrays(rollout), ROLLOUT_COLUMNS)
    source = _source(rollout.plan_id, rollout.terrain_hash, rollout.robot_hash)
    return _text(header, rows, {}, source)


def _source(plan_id: str, terrain_hash: str, robot_hash: str) -> str:
    return f"plan {plan_id} terrain {terrain_hash} robot {robot_hash}"


def _text(header: list[str], rows: Floats, extra: dict[str, list[str]], source: str) -> bytes:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*header, *extra, "source"])
    for i, row in enumerate(rows.tolist()):
        # repr is the shortest text that reads back as the same number.
        numbers = [repr(value) for value in row]
        writer.writerow([*numbers, *(column[i] for column in extra.values()), source])
    return out.getvalue().encode()
