"""Pages of listed origins may call, in a real browser; others may not."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

import pytest

from stairwright.api.settings import Settings
from stairwright.errors import InputError
from tests.conftest import Server

if TYPE_CHECKING:
    from playwright.sync_api import Browser

Start = Callable[..., contextlib.AbstractContextManager[Server]]
TOKEN = "correct-horse-battery"

# What an integrator's page does: plans, rolls out, saves and deletes, and reads the headers.
CALLS = """async ([api, token]) => {
  const headers = { "content-type": "application/json", ...(token && {
    authorization: `Bearer ${token}` }) };
  const terrain = { points: [[-1, 0], [0, 0], [0, 0.02], [1, 0.02]] };
  const call = (path, method, body, more) => fetch(api + path, {
    method, headers: { ...headers, ...more }, body: body && JSON.stringify(body) });
  try {
    const plan = await call("/plans", "POST", { terrain, method: "critical" });
    const again = await call(plan.headers.get("content-location").slice(7), "GET", undefined,
      { "if-none-match": plan.headers.get("etag") });
    const job = await call("/rollouts", "POST", { plan_id: (await plan.json()).id },
      { "idempotency-key": "once" });
    const gone = await call(job.headers.get("location").slice(7), "DELETE");
    const saved = await call("/terrains/of-a-friend", "PUT", terrain);
    const listed = await call("/terrains?limit=1", "GET");
    const removed = await call("/terrains/of-a-friend", "DELETE");
    return {
      statuses: [plan, again, job, gone, saved, listed, removed].map(answer => answer.status),
      wait: job.headers.get("retry-after"),
      total: Number(listed.headers.get("x-total-count")),
    };
  } catch (error) {
    return String(error);
  }
}"""


class Blank(BaseHTTPRequestHandler):
    """A site with an empty page."""

    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("content-type", "text/html")
        self.end_headers()
        self.wfile.write(b"<!doctype html><title>another site</title>")

    def log_message(self, *_: Any) -> None:
        """Say nothing."""


@contextlib.contextmanager
def site() -> Iterator[str]:
    """A web site of another origin; its origin."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), Blank)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    thread.join()
    server.server_close()


@pytest.mark.browser
def test_another_sites_page_in_a_browser(start_server: Start, browser: Browser) -> None:
    with site() as friend, site() as stranger:
        settings = {"STAIRWRIGHT_ORIGINS": friend, "STAIRWRIGHT_TOKEN": TOKEN}
        with start_server(**settings) as server, browser.new_context() as context:
            page = context.new_page()
            api = f"{server.url}/api/v1"
            page.goto(friend)
            told = page.evaluate(CALLS, [api, TOKEN])
            assert isinstance(told, dict), told
            assert told["statuses"][:3] == [200, 304, 202]
            assert told["statuses"][3:6] in ([200, 201, 200], [200, 200, 200])
            assert told["statuses"][6] == 204
            assert told["wait"] == "1"
            assert told["total"] > 1
            refused = page.evaluate(
                "url => fetch(url).then(a => [a.status, a.headers.get('www-authenticate')])",
                f"{api}/terrains",
            )
            assert refused[0] == 401
            assert refused[1].startswith("Bearer")
            page.goto(stranger)
            assert page.evaluate(CALLS, [api, TOKEN]) == "TypeError: Failed to fetch"


@pytest.mark.parametrize(
    "origins", ["friend.example", "*", "null", "https://a.example/page", "ftp://a", "https://u@a"]
)
def test_origins_that_are_none_are_refused_at_the_start(origins: str) -> None:
    with pytest.raises(InputError, match="STAIRWRIGHT_ORIGINS"):
        Settings(origins=origins)
