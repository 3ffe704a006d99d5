"""A new process that plans loads no library that plans do without."""

from __future__ import annotations

import subprocess
import sys

HEAVY = ("casadi", "mujoco", "scipy", "fastapi", "viser")
SCRIPT = """
import sys
import stairwright as sw
for method in ("path", "critical"):
    assert sw.plan("curb-015", method=method).feasible
print(*(name for name in sys.argv[1:] if name in sys.modules))
"""


def test_a_plan_imports_nothing_heavy() -> None:
    ran = subprocess.run(
        [sys.executable, "-c", SCRIPT, *HEAVY], check=True, capture_output=True, text=True
    )
    assert ran.stdout.split() == []
