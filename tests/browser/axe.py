"""What axe-core finds that shuts out people who do not see the page or use no mouse."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from playwright.sync_api import Page

AXE = Path(__file__).parents[2] / "frontend" / "node_modules" / "axe-core" / "axe.min.js"
SERIOUS = {"serious", "critical"}
# The scene's frame is viser's page, not ours.
# Describing what passes, and handing it over, takes longer than finding what does not.
RUN = """room => axe.run(
  room || { exclude: [['iframe']] }, { iframes: false, resultTypes: ['violations'] }
).then(found => found.violations)"""


def violations(page: Page, room: str = "", *, minor: bool = False) -> list[dict[str, Any]]:
    """Rules that the page breaks, with the elements; a selector may name a part of it."""
    if not page.evaluate("'axe' in window"):
        page.evaluate(AXE.read_text(encoding="utf-8"))
    return [
        {"id": v["id"], "nodes": [(n["html"][:200], n["failureSummary"]) for n in v["nodes"]]}
        for v in page.evaluate(RUN, room)
        if minor or v["impact"] in SERIOUS
    ]
