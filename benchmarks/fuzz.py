"""Requests that no honest client sends, by the hundred thousand: none may be answered with a 5xx.

    python benchmarks/fuzz.py [--count 100000] [--seed 0] [--url URL] [--quick] [--json FILE]

Valid requests to every route are damaged at random: values replaced by hostile ones, fields added,
taken away or nested, bytes flipped, bodies cut, headers and addresses made up. The same seed gives
the same requests. Ends with status 1 after a 5xx or a broken connection, and prints the request.
Without `--url` it starts a server of its own, and checks that no worker is left over or lost.
"""

from __future__ import annotations

import argparse
import contextlib
import copy
import json
import random
import statistics
import sys
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import quote

import httpx
from report import Row, percentile, publish
from service import Service, serve

import stairwright as sw

FLAT = {"points": [[-1, 0], [1, 0]]}
STEP = {"name": "s", "points": [[-1, 0], [0, 0], [0, 0.05], [1, 0.05]], "friction": 0.6}
QUESTION = {"terrain": STEP, "robot": "a1_wheeled", "friction": 0.6, "method": "critical",
            "weights": {"com_x": 50.0}}  # fmt: skip
ROBOT = sw.load_robot("a1_wheeled").model_dump(mode="json", by_alias=True)
AXES = [{"name": "step.height", "values": [0.05, 0.1]}, {"name": "friction", "values": [0.6]}]
STUDY = {"schema": "stairwright/study/1", "robot": "a1_wheeled", "axes": AXES}
DESIGN = {"schema": "stairwright/design/1", "ask": {"robot": "a1_wheeled", "axes": AXES[:1]},
          "vary": [{"name": "robot.actuators.leg.torque", "between": [2, 40]}],
          "aims": [{"minimise": "robot.actuators.leg.torque"}], "designs": 2, "generation": 2,
          "seed": 0}  # fmt: skip
WORLD = {"friction": 0.5, "payload": {"mass": 0.5, "place": [0.0, 0.0, 0.1]}, "delay": 0.004,
         "step_height_error": [0.01, -0.01], "face_place_error": 0.01, "heading": 0.02,
         "friction_wheels": [0.5, 0.5, 0.6, 0.6], "imu": {}}  # fmt: skip
ROUTES: list[tuple[str, str, Any]] = [
    ("POST", "/plans", QUESTION),
    ("POST", "/plans", {"terrain": FLAT, "method": "nominal"}),
    ("POST", "/plans", {"terrain": {"kind": "stair", "rise": 0.05, "run": 0.3, "count": 2}}),
    ("POST", "/rollouts", {"terrain": FLAT, "method": "nominal", "seed": 1, "friction": 0.5,
                           "controller": {"form": "contact"}}),
    ("POST", "/rollouts", {"plan_id": "p-0123456789abcdef", "seed": 3}),
    ("POST", "/terrains/generate", {"kind": "stair", "rise": 0.2, "run": 0.3, "count": 3}),
    ("POST", "/terrains/generate", {"kind": "ramp", "height": 0.2, "angle": 0.4, "name": "r"}),
    ("POST", "/terrains/generate", {"kind": "flat", "length": 3.0}),
    ("PUT", "/terrains/fuzzed", {"name": "fuzzed", **FLAT}),
    ("DELETE", "/terrains/fuzzed", None),
    ("POST", "/plans", {"terrain": STEP, "robot": ROBOT, "timing": "fast"}),
    ("POST", "/plans", {"terrain": STEP, "tolerance": {"height": 0.01, "place": 0.01,
                                                       "friction": 0.05}}),
    ("POST", "/rollouts", {"terrain": FLAT, "method": "nominal", "disturbance": WORLD}),
    ("POST", "/trials", {"terrain": FLAT, "method": "nominal", "count": 2,
                         "ranges": {"friction": [-0.05, 0.05]}}),
    ("POST", "/trials", {"terrain": FLAT, "method": "nominal", "count": 2, "bundle": "field"}),
    ("POST", "/margins", {"terrain": FLAT, "method": "nominal", "seed": 1}),
    ("PUT", "/robots/fuzzed", ROBOT | {"name": "fuzzed"}), ("DELETE", "/robots/fuzzed", None),
    ("POST", "/robots/export?format=urdf", ROBOT),
    ("POST", "/studies", STUDY), ("POST", "/designs", DESIGN),
    ("GET", "/studies", None), ("GET", "/studies/s-0123456789abcdef/cells?from=0", None),
    ("GET", "/studies/s-0123456789abcdef/export?format=csv", None),
    ("POST", "/studies/s-0123456789abcdef/cancel", None), ("GET", "/designs", None),
    ("POST", "/designs/d-0123456789abcdef/cancel", None),
    ("PUT", "/sessions/none/scene", {"plan_id": "p-0123456789abcdef", "theme": "dark"}),
    ("PUT", "/sessions/none/playback", {"time": 1.0, "playing": True}),
    ("GET", "/terrains", None), ("GET", "/terrains/flat", None), ("GET", "/robots", None),
    ("GET", "/robots/a1_wheeled", None), ("GET", "/plans?limit=3&offset=1", None),
    ("GET", "/plans/p-0123456789abcdef", None), ("GET", "/rollouts/r-0123456789abcdef", None),
    ("GET", "/plans/p-0123456789abcdef/export?format=csv", None),
    ("GET", "/rollouts/r-0123456789abcdef/export?format=html", None),
    ("GET", "/jobs/j-0123456789", None), ("GET", "/jobs/j-0123456789/events", None),
    ("DELETE", "/jobs/j-0123456789", None), ("GET", "/settings", None),
    ("GET", "/healthz", None), ("GET", "/openapi.json", None), ("GET", "/nothing", None),
]  # fmt: skip
STUDIES = "stairwright.studies"  # whose processes wait a while for the next study
HOSTILE: list[Any] = [
    None, True, False, 0, -1, 1e308, -1e308, 1e-320, 2**31, 2**63, 2**64, -(2**63), 1.5, "", "x",
    "flat", "../../etc/passwd", "/etc/passwd", "\x00", "\ud800", "\u202e", "a" * 5000, "NaN", [],
    {}, [[]], [{}], {"a": {}}, [0] * 3000, [[0, 0]] * 2001, "1e999", "Infinity", "%s%n", "{{7*7}}",
    "<script>", "'; DROP TABLE plans;--", ["stair"], {"$ref": "#"}, {"__proto__": {}},
]  # fmt: skip
LITERALS = ("NaN", "Infinity", "-Infinity", "1e999", "-1e999", "9" * 400, "0x10", "01", "+1")
METHODS = ("GET", "POST", "PUT", "DELETE", "PATCH", "HEAD", "OPTIONS", "TRACE", "BREW")
KINDS = ("application/json", "application/json; charset=utf-7", "text/plain", "a/b", "",
         "multipart/form-data; boundary=x", "application/problem+json")  # fmt: skip


@dataclass
class Request:
    """What is sent."""

    method: str
    path: str
    body: bytes | None = None
    headers: dict[str, str] = field(default_factory=dict)


def places(node: Any, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Paths of all values in a JSON document."""
    yield at
    if isinstance(node, (dict, list)):
        for key, value in node.items() if isinstance(node, dict) else enumerate(node):
            yield from places(value, (*at, key))


def damage(document: Any, chance: random.Random) -> Any:
    """The document with one place changed."""
    made = copy.deepcopy(document)
    where = chance.choice(list(places(made)))
    if not where:
        return chance.choice(HOSTILE)
    parent = made
    for key in where[:-1]:
        parent = parent[key]
    what = chance.randrange(4)
    if what == 0:
        del parent[where[-1]]
    elif what == 1 and isinstance(parent, dict):
        parent[chance.choice(["a", "", "\ud800", "schema", "id", "k" * 300])] = chance.choice(
            HOSTILE
        )
    elif what == 2:
        parent[where[-1]] = [parent[where[-1]]] * chance.choice([1, 2, 9])
    else:
        parent[where[-1]] = chance.choice(HOSTILE)
    return made


def spoil(content: bytes, chance: random.Random) -> bytes:
    """Bytes flipped, cut, doubled, or numbers replaced by what is none."""
    what = chance.randrange(5)
    if what == 0:
        return content[: chance.randrange(len(content) + 1)]
    if what == 1:
        at = chance.randrange(len(content))
        return content[:at] + bytes([chance.randrange(256)]) + content[at + 1 :]
    if what == 2:
        return content + content
    if what == 3:
        depth = chance.choice([10, 1000, 50_000])
        return b'{"terrain":' + b"[" * depth + b"]" * depth + b"}"
    digits = [k for k, byte in enumerate(content) if 48 <= byte < 58]
    at = chance.choice(digits) if digits else 0
    return content[:at] + chance.choice(LITERALS).encode() + content[at + 1 :]


def requests(count: int, seed: int) -> Iterator[Request]:
    """Damaged requests."""
    chance = random.Random(seed)
    for _ in range(count):
        method, path, document = chance.choice(ROUTES)
        request = Request(method, path)
        if document is not None:
            for _ in range(chance.choice([1, 1, 2, 4])):
                document = damage(document, chance)
            content = json.dumps(document).encode()
            request.body = spoil(content, chance) if chance.random() < 0.3 else content
            request.headers["content-type"] = KINDS[0]
        _odd(request, chance)
        yield request


def _odd(request: Request, chance: random.Random) -> None:
    """Now and then another method, address or header."""
    if chance.random() < 0.05:
        request.method = chance.choice(METHODS)
    if chance.random() < 0.1:
        head, _, last = request.path.rpartition("/")
        text = str(chance.choice(HOSTILE))[:200].encode("utf-8", "surrogatepass")
        strange = f"{head}/{quote(text, safe='')}"
        asked = (
            f"{request.path}{'&' if '?' in last else '?'}limit={quote(text)}&format={quote(text)}"
        )
        request.path = strange if chance.random() < 0.7 else asked
    if chance.random() < 0.1:
        name = chance.choice(["content-type", "idempotency-key", "accept-encoding", "if-none-match",
                              "last-event-id", "origin", "x-request-id", "cookie", "range",
                              "authorization", "stairwright-session"])  # fmt: skip
        value = chance.choice([*KINDS, "a" * 999, "\x7f", "-1", "*", "gzip;q=x", "https://evil"])
        request.headers[name] = value


@dataclass
class Tally:
    """What came back."""

    statuses: Counter[int] = field(default_factory=Counter)
    refused: list[float] = field(default_factory=list)  # times of 4xx [ms]
    bad: list[str] = field(default_factory=list)


def bombard(url: str, count: int, seed: int) -> Tally:
    """Send all of them, one after the other."""
    tally = Tally()
    with httpx.Client(base_url=url, timeout=90) as api:
        for request in requests(count, seed):
            begun = time.perf_counter()
            try:
                answer = api.request(
                    request.method, request.path, content=request.body, headers=request.headers
                )
            except httpx.TransportError as error:
                tally.bad.append(f"{request}: {error!r}")
                continue
            spent = 1e3 * (time.perf_counter() - begun)
            tally.statuses[answer.status_code] += 1
            if answer.status_code >= 500:
                tally.bad.append(f"{request}: {answer.status_code} {answer.text[:500]}")
            elif answer.status_code >= 400:
                tally.refused.append(spent)
            elif answer.status_code == 202:
                api.delete(answer.headers["location"].removeprefix("/api/v1"))
    return tally


def run(quick: bool = False, count: int | None = None, seed: int = 0, url: str = "") -> Tally:
    """Bombard the server at `url`, or one of our own."""
    count = count or (2000 if quick else 100_000)
    with contextlib.ExitStack() as stack:
        own: Service | None = None if url else stack.enter_context(serve(log_level="error"))
        before = 0
        if own is not None:
            time.sleep(5.0)  # all workers are there
            before = len(own.processes(without=STUDIES))
        tally = bombard(f"{url}/api/v1" if own is None else own.api, count, seed)
        if own is not None:
            time.sleep(2.0)
            if (after := len(own.processes(without=STUDIES))) != before:
                tally.bad.append(f"{before} processes before, {after} after")
    return tally


def rows(tally: Tally) -> list[Row]:
    """The figures."""
    total = sum(tally.statuses.values())
    counts = ", ".join(f"{n} x {status}" for status, n in sorted(tally.statuses.items()))
    failed = sum(n for status, n in tally.statuses.items() if status >= 500)
    note = f"p99 {percentile(tally.refused, 0.99):.1f} ms, {counts}"
    return [Row("malformed request refused", "stairwright", statistics.median(tally.refused),
                percentile(tally.refused, 0.95), solved=f"{failed} of {total} are 5xx",
                note=note)]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, help="requests (100000)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--url", default="")
    parser.add_argument("--quick", action="store_true", help="2000 requests")
    parser.add_argument("--json")
    given = parser.parse_args()
    tally = run(given.quick, given.count, given.seed, given.url)
    for each in tally.bad[:20]:
        print(each, file=sys.stderr)
    publish(rows(tally), given.json)
    sys.exit(1 if tally.bad else 0)


if __name__ == "__main__":
    main()
