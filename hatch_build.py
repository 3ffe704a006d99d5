"""Put what a checkout keeps at its top level into the wheel: terrains, robots and the built page.

A wheel holds them as `stairwright/data/terrains`, `stairwright/data/robots` and
`stairwright/page`. An editable install needs none of this: it reads the checkout.
"""

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SHIPPED = {
    "terrains": "stairwright/data/terrains",
    "robots": "stairwright/data/robots",
    "frontend/dist": "stairwright/page",
}


class ShipData(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the data folders to standard wheels."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called before each build; `version` is "standard" or "editable"."""
        if self.target_name != "wheel" or version == "editable":
            return
        for source, target in SHIPPED.items():
            folder = Path(self.root, source)
            if not folder.is_dir():
                hint = " Build the page first: ./dev build" if source == "frontend/dist" else ""
                raise FileNotFoundError(f"{folder} is missing.{hint}")
            build_data["force_include"][str(folder)] = target
