"""Names and addresses in settings, read strictly: a misspelt one would lock people out or in."""

from __future__ import annotations

import ipaddress
import re
from urllib.parse import urlsplit

from stairwright.errors import InputError

MOST_PORT = 65535
Network = ipaddress.IPv4Network | ipaddress.IPv6Network

_NAME = re.compile(r"[a-z0-9_]([\w-]*[a-z0-9_])?(\.[a-z0-9_]([\w-]*[a-z0-9_])?)*", re.ASCII)


def host(text: str) -> str:
    """A host's name or address, without port.

    Raises:
        InputError: If it is anything else.
    """
    name = text.strip("[]").rstrip(".").lower()
    if not _NAME.fullmatch(name) and not is_address(name):
        raise InputError(
            f"STAIRWRIGHT_HOSTS takes names such as stairs.example, without port, not {text!r}"
        )
    return name


def is_address(text: str) -> bool:
    """Whether it is an IP address."""
    try:
        ipaddress.ip_address(text)
    except ValueError:
        return False
    return True


def origin(text: str) -> str:
    """A web origin as browsers write it.

    Raises:
        InputError: If it is anything else.
    """
    try:
        parts = urlsplit(text.lower())
        written = f"{parts.scheme}://{parts.netloc}"
        fine = parts.scheme in ("http", "https") and parts.hostname and parts.port != 0
    except ValueError:
        fine = False
    if not fine or text.lower() not in (written, f"{written}/") or "@" in text:
        raise InputError(
            f"STAIRWRIGHT_ORIGINS takes origins such as https://editor.example, not {text!r}"
        )
    return written


def network(text: str) -> Network:
    """An address or a network of addresses.

    Raises:
        InputError: If it is anything else.
    """
    try:
        return ipaddress.ip_network(text)
    except ValueError:
        raise InputError(
            f"STAIRWRIGHT_PROXIES takes addresses such as 10.0.0.7 or 10.0.0.0/24, not {text!r}"
        ) from None
