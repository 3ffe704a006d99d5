"""A cluster of this machine's cores: a scheduler and its workers in processes of their own.

    python -m stairwright.studies.local_cluster --workers 4

Tells on the first line of its output where it listens and with which keys, as JSON, and ends when
its input is closed, that is, whenever and however its parent ends. Connections are encrypted with
keys that live as long as the cluster: a port of the loopback is open to every user of a machine,
and whoever may talk to a scheduler may run code.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import subprocess
import sys
import threading
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from distributed import Security

START_LIMIT = 60.0  # s
DEATHS = 1  # of workers at one batch, before it is split
# What looks at workers many times a second takes time from them.
QUIET = {
    "distributed.worker.profile.enabled": False,
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.scheduler.http.routes": [],  # nobody looks at pages of ours
    "distributed.worker.http.routes": [],
}


class LocalCluster:
    """Starts in the background; who asks for its `address` waits."""

    def __init__(self, workers: int) -> None:
        command = [sys.executable, "-m", __name__, "--workers", str(workers)]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True
        )
        self._told: dict[str, Any] | None = None
        self._ready = threading.Event()
        threading.Thread(target=self._listen, daemon=True, name="cluster-start").start()

    def _listen(self) -> None:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        self._told = json.loads(line) if line else None
        self._ready.set()

    @property
    def pid(self) -> int:
        """Of the process that holds the scheduler."""
        return self._process.pid

    @property
    def address(self) -> str:
        """Of the scheduler; waits for it.

        Raises:
            RuntimeError: If it did not start.
        """
        self._ready.wait(START_LIMIT)
        if self._told is None:
            raise RuntimeError("the processes for studies did not start")
        return str(self._told["address"])

    @property
    def security(self) -> Security:
        """What opens it."""
        from distributed import Security

        assert self._told is not None
        cert, key = self._told["cert"], self._told["key"]
        return Security(
            require_encryption=True,
            tls_ca_file=cert,
            tls_client_cert=cert,
            tls_client_key=key,
        )

    def close(self) -> None:
        """End it; does not fail if it has ended."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.close()
            self._process.wait(10)
        except (subprocess.TimeoutExpired, BrokenPipeError):
            self._process.kill()
            self._process.wait()
        assert self._process.stdout is not None
        self._process.stdout.close()


def main() -> None:
    """Serve until the input ends."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--workers", type=int, required=True)
    workers = parser.parse_args().workers
    import dask
    from distributed import LocalCluster as Dask
    from distributed import Security

    dask.config.set(
        QUIET
        | {
            "distributed.scheduler.allowed-failures": DEATHS,
            "distributed.worker.daemon": True,
            "distributed.nanny.pre-spawn-environ.OPENBLAS_NUM_THREADS": 1,
        }
    )
    security = Security.temporary()
    told = {
        "cert": security.tls_client_cert,
        "key": security.tls_client_key,
    }
    try:
        cluster = Dask(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            security=security,
            dashboard_address="127.0.0.1:0",
            silence_logs=50,
        )
    except RuntimeError as error:  # a worker that was killed while it started
        sys.exit(f"the processes for studies did not start: {error}")
    with cluster:
        with contextlib.suppress(BrokenPipeError):  # whoever asked has gone; so has the input
            print(json.dumps({"address": cluster.scheduler_address, **told}), flush=True)
        sys.stdin.read()


if __name__ == "__main__":
    main()
