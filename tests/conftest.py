"""What tests share: the order they run in, a real server and a real browser."""

from __future__ import annotations

import contextlib
import gc
import os
import random
import signal
import socket
import ssl
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

import httpx
import psutil
import pytest
from hypothesis import settings

from stairwright.planning.threads import one_by_one
from tests import warm_servers
from tools.system import find_browser

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

# No deadlines: tests never judge wall-clock time. CI repeats the same examples in every run.
settings.register_profile("default", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "default")

START_LIMIT = 120.0  # s until a server must answer
CHROMIUM_FLAGS = (
    "--no-sandbox",  # containers and root have none
    "--disable-dev-shm-usage",
    "--use-angle=swiftshader",  # WebGL without a graphics card
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",  # without a card that is four times the work
    "--disable-gpu-rasterization",  # which Debian's Chromium asks for
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-quic",
    # Hidden pages of the address bar cost each window 0.7 s of processor time.
    "--disable-features=WebUIOmniboxPopup,WebUIOmniboxAimPopup",
    "--no-first-run",
)

# Playwright waits for functions by `eval`, which the page's policy forbids; see test_policy.py
TAB: dict[str, Any] = {
    "viewport": {"width": 1440, "height": 900},
    "accept_downloads": True,
    "bypass_csp": True,
}


@pytest.fixture(autouse=True)
def planning_threads() -> Iterator[None]:
    """Tests that share the cores plan without threads: what these do ahead keeps others waiting."""
    with one_by_one() if "PYTEST_XDIST_WORKER" in os.environ else contextlib.nullcontext():
        yield


processes: list[int] = []  # that share the tests of this one


@pytest.hookimpl(optionalhook=True)
def pytest_testnodeready(node: Any) -> None:
    """Another process has begun to take part."""
    processes.append(node.gateway._io.popen.pid)


def pytest_configure() -> None:
    """A run that is told to end takes its servers along, as Ctrl-C does."""

    runner = os.getpid()

    def interrupt(number: int, _frame: object) -> None:
        if os.getpid() == runner:
            for process in processes:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, number)
            raise KeyboardInterrupt
        signal.signal(number, signal.SIG_DFL)  # a forked worker ends as it would without us
        os.kill(os.getpid(), number)

    signal.signal(signal.SIGTERM, interrupt)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Quick tests first, then the slow ones, then the browser's.

    Playwright leaves an event loop behind that others would stumble over. Large modules come first
    of these last ones, so that processes that share the work end about together.
    """
    sizes = Counter(item.path for item in items if item.get_closest_marker("browser"))

    def rank(item: pytest.Item) -> tuple[int, int]:
        if item.get_closest_marker("browser"):
            return 2, -sizes[item.path]
        return (1, 0) if item.get_closest_marker("slow") else (0, 0)

    items.sort(key=rank)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, Any, Any]:
    """All that is imported stays: looking for garbage there took a tenth of the tests' time."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Processes that share the work take a module's tests of one kind at a time, in this order.

    What a module starts or builds is then made once. `--dist loadgroup` would say the same with
    marks, but xdist 3.8 writes them where pytest 9.2 no longer looks.
    """
    from itertools import groupby

    from xdist.scheduler import LoadScopeScheduling

    class ModuleScheduling(LoadScopeScheduling):
        units: dict[str, str]  # of each test

        def schedule(self) -> None:
            if self.collection is None:
                tests = next(iter(self.registered_collections.values()))
                modules = groupby(tests, key=lambda test: test.split("::")[0])
                self.units = {
                    test: f"{k} {name}" for k, (name, group) in enumerate(modules) for test in group
                }
            super().schedule()

        def _split_scope(self, test: str) -> str:
            return self.units[test]

    config.option.loadscopereorder = False
    return ModuleScheduling(config, log)


@pytest.fixture(scope="session", autouse=True)
def _certificates_read_once() -> Iterator[None]:
    """httpx reads a system's for every client, TLS or not: 20 ms of processor time each."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ssl, "create_default_context", cache(ssl.create_default_context))
        yield


@dataclass(frozen=True)
class Server:
    """A running `stairwright serve`: where it answers, and the folder it keeps its data in."""

    url: str
    data: Path
    process: psutil.Process
    log: Path


# Below those that systems give to connections: one of these might have it before a server does.
_FIRST_PORT, _PORTS = 20_000, 1_000
_ports = count(random.randrange(_PORTS))


def free_port() -> int:
    """One that nobody listens at, of this worker's own."""
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    first = _FIRST_PORT + _PORTS * (worker % 10)
    while True:
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("127.0.0.1", first + next(_ports) % _PORTS))
            return int(probe.getsockname()[1])


@contextlib.contextmanager
def serve(
    data: Path,
    prefix: Sequence[str] = (),
    port: int = 0,
    cold: bool = False,
    **variables: str,
) -> Iterator[Server]:
    """A server on a data folder, until the context ends; see `start_server`."""
    port = port or free_port()
    url = f"http://127.0.0.1:{port}"
    log = data.with_name(f"{data.name}-{port}.log")
    arguments = ["serve", "--host", "127.0.0.1", "--port", str(port)]
    env = os.environ | {"STAIRWRIGHT_DATA": str(data)} | variables
    if cold or prefix or "PYTHONPATH" in variables:
        command = [*prefix, sys.executable, "-m", "stairwright", *arguments]
        with log.open("wb") as output:
            process: psutil.Process = psutil.Popen(
                command, env=env, stdout=output, stderr=subprocess.STDOUT, start_new_session=True
            )
    else:
        process = psutil.Process(warm_servers.start(arguments, env, log))
    try:
        _wait_until_ready(port, process, log)
        yield Server(url, data, process, log)
    finally:
        with contextlib.suppress(psutil.NoSuchProcess):
            process.terminate()
        try:
            process.wait(15)
        finally:  # workers that outlived the server too
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


def _wait_until_ready(port: int, process: psutil.Process, log: Path) -> None:
    give_up = time.monotonic() + START_LIMIT
    with httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1", timeout=5) as client:
        while time.monotonic() < give_up:
            with contextlib.suppress(psutil.TimeoutExpired):
                process.wait(0)
                break
            with contextlib.suppress(httpx.TransportError):
                if client.get("/healthz").status_code == 200:
                    return
            time.sleep(0.1)
    pytest.fail(f"The server did not start:\n{log.read_text(errors='replace')[-5000:]}")


@pytest.fixture
def start_server(
    tmp_path: Path,
) -> Callable[..., contextlib.AbstractContextManager[Server]]:
    """A server of the test's own: `with start_server(STAIRWRIGHT_TOKEN="t") as server: ...`.

    Servers that one test starts share one data folder, so a restart finds what was saved.
    `prefix` is a command that runs the server; a `cold` one imports everything by itself.
    """
    return lambda **given: serve(tmp_path / "data", **given)


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """One real server for all tests that do not mind what other tests saved there."""
    with serve(tmp_path_factory.mktemp("server") / "data") as running:
        yield running


@pytest.fixture(scope="session")
def browser_path() -> str:
    """Where Chromium is; without one the test fails, since a skipped test proves nothing."""
    found = find_browser()
    if found is None:
        pytest.fail("No Chromium here: run ./dev test, or install one, or set STAIRWRIGHT_BROWSER.")
    return found


@pytest.fixture(scope="session")
def browser(browser_path: str) -> Iterator[Browser]:
    """A headless Chromium."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(
            executable_path=browser_path, args=list(CHROMIUM_FLAGS)
        )
        yield launched
        launched.close()


@pytest.fixture
def page(browser: Browser, server: Server) -> Iterator[Page]:
    """An empty tab with a profile of its own; `page.goto("/")` opens the product."""
    with browser.new_context(**TAB, base_url=server.url) as context:
        yield context.new_page()
