"""Put what a checkout keeps at its top level into the wheel: terrains, robots, the built page.

A wheel holds them as `stairwright/data/terrains`, `stairwright/data/robots` and
`stairwright/page`, the native core's sources as `stairwright/data/native` (bundles for robots
bring them along), and the native core that ./dev has built beside the Python files. An editable
install needs none of this: it reads the checkout.
"""

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SHIPPED = {
    "terrains": "stairwright/data/terrains",
    "robots": "stairwright/data/robots",
    "native": "stairwright/data/native",
    "frontend/dist": "stairwright/page",
}


class ShipData(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the data folders to standard wheels."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called before each build; `version` is "standard" or "editable"."""
        if self.target_name != "wheel" or version == "editable":
            return
        root = Path(self.root)
        native = sorted((root / "backend/stairwright").glob("_core.*"))
        missing = [name for name in SHIPPED if not (root / name).is_dir()]
        if missing or not native:
            what = " and ".join([*missing, *([] if native else ["the native core"])])
            # Ends pip's and hatchling's own process; an exception would bury it in a traceback.
            raise SystemExit(
                f"{what} must be built first; one command builds them and the wheel: ./dev wheel"
            )
        files = {str(root / source): target for source, target in SHIPPED.items()}
        files |= {str(file): f"stairwright/{file.name}" for file in native}
        build_data["force_include"].update(files)
        # The core fits one version of Python on one kind of machine.
        build_data.update(pure_python=False, infer_tag=True)
