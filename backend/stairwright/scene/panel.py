"""viser's own panel, for the scene in a window of its own: playback, layers, plots, weights."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .motion import Motion

if TYPE_CHECKING:
    from .session import SceneSession


class Panel:
    def __init__(self, server: Any, session: SceneSession, replan: Any) -> None:
        pass

    def show(
        self,
        plan: Mapping[str, Any] | None,
        rollout: Mapping[str, Any] | None,
        motion: Motion | None,
    ) -> None:
        pass

    def tick(self, time: float) -> None:
        pass
