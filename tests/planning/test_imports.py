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
# Motors are strained here, or turn fast: judged by linear programs.
assert sw.plan("stairs-us-7-11", "go2w").feasible
assert sw.plan("curb-015", timing="fast").feasible
print(*(name for name in sys.argv[1:] if name in sys.modules))
"""


def test_a_plan_imports_nothing_heavy() -> None:
    ran = subprocess.run(
        [sys.executable, "-c", SCRIPT, *HEAVY], check=True, capture_output=True, text=True
    )
    assert ran.stdout.split() == []
