"""viser's own panel, for the scene in a window of its own: playback, layers, plots, weights."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Mapping
from typing import Any, Protocol, get_args

from viser import GuiCheckboxHandle

from stairwright.planning.weights import MODELS

from .camera import Preset
from .motion import Motion
from .palette import Palette
from .player import Player
from .stage import LAYERS
from .tracking_plots import TrackingPlots

SLIDERS_EVERY = 0.1  # s between updates of slider and plots while playing
SPEEDS = ("0.25x", "0.5x", "1x", "2x", "4x")


class Scene(Protocol):
    """What the panel steers."""

    @property
    def player(self) -> Player:
        """The clock."""

    def playback(
        self, *, time: float | None = None, playing: bool | None = None, speed: float | None = None
    ) -> None:
        """Set the clock; what is None stays."""

    def camera(self, name: str) -> None:
        """Move the cameras to a preset."""

    def set_layers(self, layers: Mapping[str, bool]) -> None:
        """Show or hide layers."""


class Panel:
    """The panel of one session. Its callbacks run on viser's threads and call the scene."""

    def __init__(
        self,
        server: Any,
        scene: Scene,
        replan: Callable[[dict[str, float]], None] | None,
    ) -> None:
        self._gui, self._scene, self._replan = server.gui, scene, replan
        self._updated = 0.0
        self._seconds = 0.0
        self._weights: dict[str, Any] = {}
        self._shown: tuple[str, str] | None = None  # method and timing of the sliders
        self._build_playback()
        self._build_layers()
        self._weights_folder = self._gui.add_folder("Weights", expand_by_default=False)
        self._weights_folder.visible = False
        self._tracking = self._gui.add_folder("Tracking")
        self._plots = TrackingPlots(self._gui, self._tracking)

    def show(
        self,
        plan: Mapping[str, Any] | None,
        rollout: Mapping[str, Any] | None,
        motion: Motion | None,
        colours: Palette,
    ) -> None:
        """Follow a new plan or rollout."""
        duration = 0.0 if motion is None else motion.duration
        self._slider.disabled = motion is None
        self._slider.max = max(math.ceil(100 * duration) / 100, 0.01)
        self._summary.content = _summary(plan, rollout)
        # Only a rollout has something to track; plans change too often while a vertex is dragged.
        self._tracking.visible = rollout is not None
        self._plots.show(rollout, motion, colours)
        if plan is not None and self._replan is not None:
            rule = "fast" if plan.get("timing", {}).get("rule") == "fast" else "steady"
            self._build_weights(plan["method"], rule, plan.get("weights", {}))

    def tick(self, time: float) -> None:
        """Follow the clock, a few times a second."""
        playing = self._scene.player.playing
        self._play.label = "Pause" if playing else "Play"
        now = clock.monotonic()
        if playing and now - self._updated < SLIDERS_EVERY:
            return
        self._updated = now
        self._slider.value = round(time, 3)
        self._plots.tick(time)

    def show_layers(self, layers: Mapping[str, bool]) -> None:
        """Follow layers that were shown or hidden from outside."""
        for name, shown in layers.items():
            self._layers[name].value = shown

    def _build_playback(self) -> None:
        gui, scene = self._gui, self._scene
        self._summary = gui.add_markdown("Nothing to show yet.")
        self._play = gui.add_button("Play")
        self._slider = gui.add_slider("Time, s", 0.0, 1.0, 0.01, 0.0)
        self._speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1x")
        self._cameras = gui.add_button_group("Camera", get_args(Preset))

        @self._play.on_click
        def _(_: Any) -> None:
            scene.playback(playing=not scene.player.playing)

        @self._slider.on_update
        def _(event: Any) -> None:
            if event.client_id is not None:  # moved by hand, not by the clock
                scene.playback(time=float(self._slider.value), playing=False)

        @self._speed.on_update
        def _(event: Any) -> None:
            if event.client_id is not None:
                scene.playback(speed=float(self._speed.value.removesuffix("x")))

        @self._cameras.on_click
        def _(_: Any) -> None:
            scene.camera(str(self._cameras.value))

    def _build_layers(self) -> None:
        self._layers: dict[str, Any] = {}
        with self._gui.add_folder("Layers", expand_by_default=False):
            for name, shown in LAYERS.items():
                box = self._gui.add_checkbox(name.replace("_", " ").capitalize(), shown)
                self._layers[name] = box
                box.on_update(self._layer_callback(name, box))

    def _layer_callback(self, name: str, box: Any) -> Callable[[Any], None]:
        def change(event: Any) -> None:
            if event.client_id is not None:
                self._scene.set_layers({name: bool(box.value)})

        return change

    def _build_weights(self, method: str, timing: str, values: Mapping[str, float]) -> None:
        """Sliders from the schema of what counts with this timing; made anew for another method."""
        if (method, timing) != self._shown:
            self._shown = (method, timing)
            for slider in self._weights.values():
                slider.remove()
            self._weights = {}
            schema = MODELS[method].model_json_schema()["properties"]  # type: ignore[index]
            with self._weights_folder:
                for name, about in schema.items():
                    linear = about.get("scale") == "linear"  # a share, not a weight
                    if about.get("timing", timing) == timing and not linear:
                        self._weights[name] = self._weight(about)
            self._weights_folder.visible = bool(self._weights)
        for name, value in values.items():
            weight = self._weights.get(name)
            truth = isinstance(weight, GuiCheckboxHandle)
            if weight is not None:
                weight.value = bool(value) if truth else round(math.log10(value), 2)

    def _weight(self, about: Mapping[str, Any]) -> Any:
        """A tick box for a truth value, else a logarithmic slider: weights are scales."""
        weight: Any
        if about["type"] == "boolean":
            weight = self._gui.add_checkbox(
                about["title"], about["default"], hint=about["description"]
            )
        else:
            low, high = math.log10(about["minimum"]), math.log10(about["maximum"])
            weight = self._gui.add_slider(
                f"{about['title']}, log₁₀",
                math.ceil(100 * low) / 100,  # never beyond the bounds
                math.floor(100 * high) / 100,
                0.01,
                round(math.log10(about["default"]), 2),
                hint=f"{about['description']} [{about['unit']}]",
            )

        @weight.on_update
        def _(event: Any) -> None:
            if event.client_id is not None and self._replan is not None:
                self._replan(self._weights_now())

        return weight

    def _weights_now(self) -> dict[str, float]:
        return {
            name: float(each.value) if isinstance(each, GuiCheckboxHandle) else 10.0**each.value
            for name, each in self._weights.items()
        }


def _summary(plan: Mapping[str, Any] | None, rollout: Mapping[str, Any] | None) -> str:
    """What is shown, in the product's words: documents' own texts are not trusted as markdown."""
    if rollout is not None:
        m = rollout["metrics"]
        return (
            f"**Rollout: {rollout['outcome']}** · {m['duration']:.1f} s · pitch error "
            f"{math.degrees(m['pitch_error_max']):.1f}° · friction {rollout['friction']:g}"
        )
    if plan is not None:
        return (
            f"**Plan: {plan['status']}** · {len(plan['poses'])} poses · "
            f"{plan['timing']['total']:.1f} s · friction {plan['friction']:g}"
        )
    return "Nothing to show yet."
