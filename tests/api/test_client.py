"""The Python client: it comes back when a busy service says so, and only then."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from email.utils import formatdate
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

import stairwright as sw
from tests.conftest import Server

CURB = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
Answer = tuple[int, dict[str, str]]
Start = Callable[..., AbstractContextManager[Server]]


@contextmanager
def answering(*answers: Answer) -> Iterator[tuple[str, list[str]]]:
    """A service that answers so, one after the other: its address, and the bodies it was sent."""
    waiting, bodies = list(answers), []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            length = int(self.headers.get("content-length", 0))
            bodies.append(self.rfile.read(length).decode())
            status, headers = waiting.pop(0)
            body = b"[]" if status == 200 else json.dumps({"status": status}).encode()
            self.send_response(status)
            for name, value in {**headers, "content-length": str(len(body))}.items():
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(body)

        do_POST = do_GET

        def log_message(self, *_: object) -> None:
            pass  # not into the test's output

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", bodies
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def test_it_comes_back_when_told() -> None:
    soon = formatdate(time.time() + 1.0, usegmt=True)
    told: list[Answer] = [
        (429, {"retry-after": "1"}),
        (503, {"retry-after": "0"}),
        (503, {"retry-after": soon}),
        (200, {}),
    ]
    start = time.monotonic()
    with answering(*told) as (url, bodies), sw.Client(url) as service:
        assert service.terrains() == []
    assert len(bodies) == 4
    assert time.monotonic() - start >= 1.0  # no sooner


@pytest.mark.slow
@pytest.mark.parametrize(
    ("answer", "patience"),
    [
        ((503, {}), 60.0),  # a proxy that does not say when
        ((429, {"retry-after": "soon"}), 60.0),
        ((429, {"retry-after": "3600"}), 60.0),
        ((429, {"retry-after": "1"}), 0.0),
        ((500, {"retry-after": "1"}), 60.0),
    ],
)
def test_it_does_not_come_back_otherwise(answer: Answer, patience: float) -> None:
    with (
        answering(answer) as (url, bodies),
        sw.Client(url, patience=patience) as service,
        pytest.raises(sw.ServiceError) as caught,
    ):
        service.terrains()
    assert caught.value.status == answer[0]
    assert len(bodies) == 1


@pytest.mark.slow
def test_a_full_queue_takes_all_rollouts_in_the_end(start_server: Start) -> None:
    few = {"STAIRWRIGHT_QUEUE_LIMIT": "1", "STAIRWRIGHT_ROLLOUT_WORKERS": "1"}
    with start_server(**few) as server, sw.Client(server.url) as service:
        plan = service.plan(CURB, method="critical")
        refused = []
        with sw.Client(server.url, patience=0) as hasty:
            for seed in range(4):
                try:
                    hasty.submit(plan_id=plan.id, seed=seed)
                except sw.ServiceError as error:
                    refused.append(error.status)
        assert 429 in refused
        jobs = [service.submit(plan_id=plan.id, seed=10 + i) for i in range(3)]
        runs = {service.result(service.wait(job.id)).id for job in jobs}
        assert len(runs) == 3
