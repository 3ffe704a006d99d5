"""From `stairwright serve` to the first plan, and whether the first ones pay for the start.

    python benchmarks/start.py [--repeat 5] [--quick] [--json FILE]

Starts servers with a fresh data folder each (compiled code is warm, as after `./dev setup`) and
asks for ten plans that nobody has asked for before, as soon as the server says that it is ready.
"""

from __future__ import annotations

import argparse
import time

import httpx
from report import Row, percentile, publish, row
from service import serve

PLANS = 10


def start() -> tuple[float, float, list[float]]:
    """Times from the start [ms]: ready, first plan answered; and of each plan by itself."""
    begun = time.perf_counter()
    with serve() as service, httpx.Client(base_url=service.api, timeout=120) as api:
        ready = time.perf_counter() - begun
        answered, each = 0.0, []
        for k in range(PLANS):
            asked = time.perf_counter()
            body = {"terrain": "single-stair-036", "friction": 0.6 + 1e-4 * k}
            api.post("/plans", json=body).raise_for_status()
            each.append(1e3 * (time.perf_counter() - asked))
            answered = answered or time.perf_counter() - begun
    return 1e3 * ready, 1e3 * answered, each


def run(quick: bool = False, repeat: int | None = None) -> list[Row]:
    """All rows."""
    measured = [start() for _ in range(repeat or (1 if quick else 5))]
    firsts = [each[0] for _, _, each in measured]
    last = row("10th plan after the start", "stairwright", [each[-1] for _, _, each in measured])
    ratio = percentile([each[0] / each[-1] for _, _, each in measured], 0.5)
    return [
        row("serve until ready", "stairwright", [ready for ready, _, _ in measured]),
        row("serve until first plan answered", "stairwright", [first for _, first, _ in measured]),
        row("first plan after the start", "stairwright", firsts, (last.median or 1.0)),
        Row(last.work, last.name, last.median, last.p95, note=f"first/tenth: {ratio:.2f}"),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int)
    parser.add_argument("--quick", action="store_true", help="one start only")
    parser.add_argument("--json")
    given = parser.parse_args()
    publish(run(given.quick, given.repeat), given.json)


if __name__ == "__main__":
    main()
