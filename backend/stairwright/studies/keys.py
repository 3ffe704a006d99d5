"""Keys for a cluster of one's own: a certificate that scheduler, workers and clients share.

    python -m stairwright.studies.keys FOLDER

Writes ``cluster.pem`` and ``cluster.key`` where there are none; whoever has both may run code on
the cluster.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

CERTIFICATE, KEY = "cluster.pem", "cluster.key"


def write_keys(folder: Path) -> tuple[Path, Path]:
    """Paths of certificate and key; made where there are none, readable by their owner only."""
    from distributed import Security

    folder.mkdir(parents=True, exist_ok=True)
    paths = folder / CERTIFICATE, folder / KEY
    if not all(path.exists() for path in paths):
        made = Security.temporary()
        for path, text in zip(paths, (made.tls_client_cert, made.tls_client_key), strict=True):
            handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
            with os.fdopen(handle, "w") as file:
                file.write(text)
    return paths


def dask_settings(folder: Path) -> dict[str, str]:
    """Variables with which Dask's programs, and this one, use those keys and nothing else."""
    certificate, key = (str(folder / name) for name in (CERTIFICATE, KEY))
    prefix = "DASK_DISTRIBUTED__COMM__"
    settings = {f"{prefix}REQUIRE_ENCRYPTION": "True", f"{prefix}TLS__CA_FILE": certificate}
    for role in ("SCHEDULER", "WORKER", "CLIENT"):
        settings[f"{prefix}TLS__{role}__CERT"] = certificate
        settings[f"{prefix}TLS__{role}__KEY"] = key
    return settings


def main() -> None:
    """Write keys and say how to use them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    write_keys(folder)
    for name, value in dask_settings(folder.resolve()).items():
        print(f"export {name}={value}")


if __name__ == "__main__":
    main()
