"""Headings that settings stand under where they are shown."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any


def grouped(groups: Mapping[str, Sequence[str]]) -> Callable[[dict[str, Any]], None]:
    """For `json_schema_extra`: tells of each property the heading (`group`) it belongs under."""

    def extra(schema: dict[str, Any]) -> None:
        for group, names in groups.items():
            for name in names:
                schema["properties"][name]["group"] = group

    return extra
