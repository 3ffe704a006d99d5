"""Settings of the service, from the environment. The table in docs/ is written from this class."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from stairwright.errors import InputError
from stairwright.resources import all_cores, data_folder, default_data_folder

from . import addresses

LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})


def page_folder() -> Path:
    """The built page: inside an installed wheel, else in the checkout, where it may not exist."""
    shipped = Path(__file__).resolve().parents[1] / "page"
    return shipped if shipped.is_dir() else data_folder("frontend") / "dist"


def _about(text: str, low: float | None = None) -> dict[str, Any]:
    return {"text": text, "low": low}


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Everything that can be set; each is read from ``STAIRWRIGHT_<NAME>``."""

    host: str = field(default="127.0.0.1", metadata=_about("address to serve on"))
    port: int = field(default=8000, metadata=_about("port to serve on; 0 takes a free one", 0))
    data: Path = field(
        default_factory=default_data_folder, metadata=_about("folder of the database and results")
    )
    page: Path = field(default_factory=page_folder, metadata=_about("folder of the built page"))
    token: str = field(
        default="", metadata=_about("bearer token that everything needs; empty for none")
    )
    origins: str = field(
        default="", metadata=_about("further web origins that may call, separated by spaces")
    )
    hosts: str = field(
        default="",
        metadata=_about("names it answers to besides this machine's own, separated by spaces"),
    )
    proxies: str = field(
        default="",
        metadata=_about("addresses or networks whose X-Forwarded-For and -Proto are believed"),
    )
    token_attempts: int = field(
        default=10, metadata=_about("different wrong tokens a minute from one address", 1)
    )
    connections: int = field(default=256, metadata=_about("connections from one address", 1))
    receive_timeout: float = field(
        default=20.0, metadata=_about("time for a request to arrive; long bodies get more, s", 0.1)
    )
    keep_alive: int = field(
        default=30, metadata=_about("a connection without requests is closed after this, s", 1)
    )
    plan_workers: int = field(
        default_factory=lambda: min(4, all_cores()),
        metadata=_about("processes for interactive plans", 1),
    )
    rollout_workers: int = field(
        default_factory=lambda: max(1, all_cores() - 1),
        metadata=_about("processes for rollouts", 1),
    )
    worker_memory: int = field(
        default=4096, metadata=_about("memory limit of a worker, MiB; 0 for none", 0)
    )
    plan_deadline: float = field(default=60.0, metadata=_about("longest time for one plan, s", 0.1))
    rollout_deadline: float = field(
        default=900.0, metadata=_about("longest time for one rollout, s", 0.1)
    )
    queue_limit: int = field(default=64, metadata=_about("rollouts that may wait", 0))
    plan_queue_limit: int = field(default=64, metadata=_about("plans that may wait", 0))
    scheduler: str = field(
        default="",
        metadata=_about(
            "a Dask scheduler for studies, rollouts and trials; empty for processes of ours"
        ),
    )
    study_workers: int = field(
        default_factory=all_cores, metadata=_about("processes for studies, where there are any", 1)
    )
    study_cells: int = field(
        default=50_000, metadata=_about("plans, rollouts or trials that one study may take", 1)
    )
    study_queue_limit: int = field(default=16, metadata=_about("studies that may wait", 0))
    studies_setup: str = field(
        default="",
        metadata=_about("command that installs what studies need, where the first one lacks it"),
    )
    body_limit: int = field(
        default=256 * 1024, metadata=_about("largest request body, bytes", 1024)
    )
    upload_limit: int = field(
        default=32 * 2**20, metadata=_about("largest uploaded terrain file, bytes", 1024)
    )
    session_idle: float = field(
        default=900.0, metadata=_about("a 3D scene without use is closed after this, s", 1.0)
    )
    session_limit: int = field(default=100, metadata=_about("3D scenes open at once", 1))
    keep_bytes: int = field(
        default=20 * 2**30,
        metadata=_about("results beyond this are removed, least lately used first", 0),
    )
    log_level: str = field(default="info", metadata=_about("debug, info, warning or error"))

    def __post_init__(self) -> None:
        if self.host not in LOOPBACK and not self.token:
            raise InputError(
                f"serving on {self.host} lets others in: set STAIRWRIGHT_TOKEN to a secret first"
            )
        if self.token and (len(self.token) < 8 or not self.token.isascii()):
            raise InputError("STAIRWRIGHT_TOKEN must be at least 8 ASCII characters")
        if self.log_level not in ("debug", "info", "warning", "error"):
            raise InputError("STAIRWRIGHT_LOG_LEVEL must be debug, info, warning or error")
        if self.port > addresses.MOST_PORT:
            raise InputError(f"STAIRWRIGHT_PORT must be at most {addresses.MOST_PORT}")
        for each in fields(self):
            low, value = each.metadata["low"], getattr(self, each.name)
            if low is not None and not value >= low:
                raise InputError(f"STAIRWRIGHT_{each.name.upper()} must be at least {low:g}")
        # Each of these raises for what it cannot read.
        _ = self.allowed_origins, self.allowed_hosts, self.trusted_proxies

    @property
    def allowed_origins(self) -> frozenset[str]:
        """Web origins allowed besides the service's own."""
        return frozenset(map(addresses.origin, self.origins.split()))

    @property
    def allowed_hosts(self) -> frozenset[str]:
        """Names that requests may be addressed to."""
        return LOOPBACK | {self.host.lower()} | set(map(addresses.host, self.hosts.split()))

    @property
    def trusted_proxies(self) -> tuple[addresses.Network, ...]:
        """Where X-Forwarded-For and X-Forwarded-Proto are believed."""
        return tuple(map(addresses.network, self.proxies.split()))

    @classmethod
    def from_env(cls, environ: Mapping[str, str] | None = None, **given: Any) -> Settings:
        """Read the environment; `given` values win over it.

        Raises:
            InputError: If a variable cannot be read as its type or is out of bounds.
        """
        environ = os.environ if environ is None else environ
        values: dict[str, Any] = {}
        for each in fields(cls):
            text = environ.get(f"STAIRWRIGHT_{each.name.upper()}", "")
            if text:
                values[each.name] = _convert(each.name, str(each.type), text)
        values.update({name: value for name, value in given.items() if value is not None})
        return cls(**values)


def _convert(name: str, kind: str, text: str) -> Any:
    kinds: dict[str, Any] = {"int": int, "float": float, "str": str}
    try:
        return kinds[kind](text) if kind in kinds else Path(text).expanduser()
    except RuntimeError:
        message = f"STAIRWRIGHT_{name.upper()} begins with ~, but there is no such home folder"
        raise InputError(message) from None
    except ValueError:
        wanted = {"int": "a whole number", "float": "a number"}[kind]
        raise InputError(f"STAIRWRIGHT_{name.upper()} must be {wanted}, not {text!r}") from None
