"""The panel's plots: desired against actual, growing while the scene plays (uPlot)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from stairwright.arrays import Floats

from .motion import Motion
from .palette import Palette, Rgb

SAMPLES = 320  # a panel is about as many pixels wide
DEGREES = 180.0 / np.pi


class Curve(NamedTuple):
    """One pair of curves over time [degrees]; `leg` 0 front, 1 rear, None the trunk."""

    desired: Floats
    actual: Floats
    leg: int | None


class Chart(NamedTuple):
    """A chart's title and curves."""

    title: str
    curves: list[Curve]


def charts(rollout: Mapping[str, Any], duration: float) -> tuple[Floats, list[Chart]]:
    """Times (n,) and what to plot over them."""
    grid = np.linspace(0.0, duration, SAMPLES)
    series = rollout["series"]
    time = np.asarray(series["time"], float)

    def over(values: Floats) -> Floats:
        found: Floats = np.interp(grid, time, values * DEGREES)
        return found

    asked, reached = (np.asarray(series[name], float) for name in ("q_desired", "q"))
    pitch, wanted = (-np.asarray(series[name], float) for name in ("pitch", "pitch_desired"))

    def joint(k: int, leg: int) -> Curve:
        return Curve(over(asked[:, k]), over(reached[:, k]), leg)

    return grid, [
        Chart("Pitch, nose-up °", [Curve(over(wanted), over(pitch), None)]),
        Chart("Thigh ° · front, rear", [joint(0, 0), joint(6, 1)]),
        Chart("Calf ° · front, rear", [joint(1, 0), joint(7, 1)]),
    ]


class TrackingPlots:
    """Charts inside the current container of `gui`; replaced by `show`, advanced by `tick`."""

    def __init__(self, gui: Any, folder: Any) -> None:
        self._gui, self._folder = gui, folder
        self._handles: list[Any] = []
        self._grid: Floats = np.zeros(0)
        self._charts: list[Chart] = []
        self._shown = -1

    def show(
        self, rollout: Mapping[str, Any] | None, motion: Motion | None, colours: Palette
    ) -> None:
        """Draw the charts of a new motion."""
        for handle in self._handles:
            handle.remove()
        self._handles, self._charts, self._shown = [], [], -1
        if rollout is None or motion is None:
            return
        self._grid, self._charts = charts(rollout, motion.duration)
        with self._folder:
            for chart in self._charts:
                self._handles.append(
                    self._gui.add_uplot(
                        self._data(chart, len(self._grid)),
                        _series(chart, colours),
                        title=chart.title,
                        scales={
                            "x": {"time": False, "range": (0.0, max(motion.duration, 0.01))},
                            "y": {"range": _range(chart)},
                        },
                        axes=_axes(colours),
                        legend={"show": False},
                        height=150,
                        padding=(0, 8, 0, 0),
                    )
                )

    def tick(self, time: float) -> None:
        """Show the actual curves up to `time`."""
        if not self._charts:
            return
        upto = int(np.searchsorted(self._grid, time, side="right"))
        if upto == self._shown:
            return
        self._shown = upto
        for chart, handle in zip(self._charts, self._handles, strict=True):
            handle.data = self._data(chart, upto)

    def _data(self, chart: Chart, upto: int) -> tuple[Floats, ...]:
        data = [self._grid]
        for curve in chart.curves:
            seen = curve.actual.copy()
            seen[upto:] = np.nan
            data += [curve.desired, seen]
        return tuple(data)


def _series(chart: Chart, colours: Palette) -> tuple[dict[str, Any], ...]:
    rows: list[dict[str, Any]] = [{"label": "s"}]
    plain = {"points": {"show": False}}
    for curve in chart.curves:
        tint = colours.path if curve.leg is None else (colours.front, colours.rear)[curve.leg]
        # Desired is a wide pale band and actual a thin line on it: legible where they coincide.
        rows.append({"label": "desired", "stroke": _css(tint, 0.35), "width": 5.0, **plain})
        rows.append({"label": "actual", "stroke": _css(tint, 1.0), "width": 1.5, **plain})
    return tuple(rows)


def _range(chart: Chart) -> tuple[float, float]:
    values = np.concatenate(
        [v for c in chart.curves for v in (c.desired, c.actual) if v is not None]
    )
    low, high = float(values.min()), float(values.max())
    room = 0.08 * (high - low) + 1.0
    return low - room, high + room


def _axes(colours: Palette) -> tuple[dict[str, Any], ...]:
    axis = {
        "stroke": _css(colours.path, 0.8),
        "grid": {"stroke": _css(colours.grid_section, 1.0), "width": 1.0},
        "ticks": {"show": False},
        "font": "10px Inter, system-ui, sans-serif",
    }
    across = {**axis, "scale": "x", "side": 2, "size": 26.0}
    return across, {**axis, "scale": "y", "side": 3, "size": 36.0}


def _css(colour: Rgb, alpha: float) -> str:
    return f"rgba({colour[0]},{colour[1]},{colour[2]},{alpha})"
