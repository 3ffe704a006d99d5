"""The atlas as pictures, docs/images/atlas-*.svg, and as tables, the marked part of its page."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl

mpl.use("svg")

import matplotlib.pyplot as plt
from atlas_studies import DOCS, STAIR, studies_of
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from stairwright.library import robots

Row = dict[str, Any]
INK, SOFT, LINE = "#121920", "#5f6c7a", "#dde3e9"
# Each friction's area and line: the less it needs, the darker.
SHADES = {0.3: "#3f9e84", 0.45: "#7fc4ac", 0.6: "#b3dfcd", 0.8: "#dcf1e8"}
DASHES = {0.3: (0, (1, 1.5)), 0.45: (0, (4, 2)), 0.6: "-", 0.8: (0, (7, 1.5, 1, 1.5))}
# Darkness and dash tell the lines apart, colour helps.
LINES = (
    ("#2c2347", "-"), ("#3a558f", "-"), ("#3a95a6", "-"), ("#4db5ad", "-"),
    ("#2c2347", "--"), ("#3a558f", "--"), ("#3a95a6", "--"),
)  # fmt: skip
# Areas of (tread, rise) [m]; the open ends are cut at 0.44 and 0.
CODES = {
    "OSHA": [(0.241, 0.0), (0.44, 0.0), (0.44, 0.241), (0.241, 0.241)],
    "IBC": [(0.279, 0.102), (0.44, 0.102), (0.44, 0.178), (0.279, 0.178)],
    "DIN": [(0.26, 0.165), (0.31, 0.14), (0.37, 0.14), (0.27, 0.19), (0.26, 0.19)],
}
BEGIN, END = "<!-- made by benchmarks/atlas.py: -->", "<!-- to here -->"


def write(rows: Sequence[Row]) -> None:
    """Draw all and put the tables in."""
    mpl.rcParams.update(
        {"font.size": 9, "axes.edgecolor": LINE, "text.color": INK, "axes.labelcolor": SOFT,
         "xtick.color": SOFT, "ytick.color": SOFT, "svg.hashsalt": "stairwright",
         "svg.fonttype": "none", "font.family": "DejaVu Sans"}
    )  # fmt: skip
    names = [name for name in robots() if any(row["robot"] == name for row in rows)]
    draw_stairs(rows, names)
    draw_lines(rows, names, "step", "highest step, m")
    draw_lines(rows, names, "payload", "largest payload, share of the robot's mass")
    page = DOCS / "atlas.md"
    text = page.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    middle = "\n\n".join(tables(rows, names))
    page.write_text(f"{before}{BEGIN}\n\n{middle}\n\n{END}{after}", encoding="utf-8")


def chosen(rows: Sequence[Row], map_name: str, robot: str, friction: float | None) -> list[Row]:
    """Rows of one line, by x."""
    found = [
        row
        for row in rows
        if row["map"] == map_name
        and row["robot"] == robot
        and (friction is None or abs(row["friction"] - friction) < 1e-9)
    ]
    return sorted(found, key=lambda row: float(row["x"]))


def _heights(line: Sequence[Row], all_pass: float) -> list[float]:
    """Borders; where all pass the range's end, where none does 0."""
    return [
        row["border"] if not math.isnan(row["border"])
        else all_pass if math.isnan(row["beyond"]) else 0.0
        for row in line
    ]  # fmt: skip


def draw_stairs(rows: Sequence[Row], names: Sequence[str]) -> None:
    """Highest rise over tread, a panel a robot."""
    figure, panels = plt.subplots(
        2, 4, figsize=(10.4, 5.4), sharex=True, sharey=True, layout="constrained"
    )
    for panel, name in zip(panels.flat, names, strict=False):
        for friction in sorted(SHADES, reverse=True):
            line = chosen(rows, "stairs", name, friction)
            xs, ys = [row["x"] for row in line], _heights(line, 0.94)
            panel.fill_between(xs, ys, color=SHADES[friction], lw=0)
            panel.plot(xs, ys, color=INK, lw=1.0, ls=DASHES[friction])
        for code, area in CODES.items():
            dash = {"OSHA": (0, (6, 2, 1, 2)), "IBC": "-", "DIN": (0, (3, 2))}[code]
            panel.add_patch(Polygon(area, fill=False, ec="white", lw=2.4))
            panel.add_patch(Polygon(area, fill=False, ec=INK, lw=0.9, ls=dash))
        panel.set_title(name, fontsize=9.5, fontweight="bold", loc="left")
        _plain(panel)
        panel.set_facecolor("#f1f4f7")
        panel.set_xlim(0.18, 0.42)
        panel.set_ylim(0, 0.94)
    for spare in panels.flat[len(names) : -1]:
        spare.axis("off")
    _key(panels.flat[-1])
    figure.supxlabel("tread, m", fontsize=9, color=SOFT)
    figure.supylabel("rise, m", fontsize=9, color=SOFT)
    figure.savefig(DOCS / "images" / "atlas-stairs.svg", metadata={"Date": None})
    plt.close(figure)


def _plain(panel: Axes) -> None:
    panel.spines[["top", "right"]].set_visible(False)
    panel.grid(color=LINE, lw=0.6)
    panel.set_axisbelow(True)
    panel.tick_params(length=2)


def _key(panel: Axes) -> None:
    """What the lines mean, in the panel that is left over."""
    panel.axis("off")
    for friction, shade in SHADES.items():
        panel.fill_between([], [], facecolor=shade, label=f"climbs at μ {friction:.2f}",
                           edgecolor=INK, lw=1.0, ls=DASHES[friction])  # fmt: skip
    panel.plot([], [], color=INK, lw=0.9, label="IBC")
    panel.plot([], [], color=INK, lw=0.9, ls=(0, (6, 2, 1, 2)), label="OSHA")
    panel.plot([], [], color=INK, lw=0.9, ls=(0, (3, 2)), label="DIN 18065")
    panel.legend(loc="center left", frameon=False)


def draw_lines(rows: Sequence[Row], names: Sequence[str], map_name: str, what: str) -> None:
    """A border over friction, a line a robot, named at its end."""
    figure, panel = plt.subplots(figsize=(7.2, 4.2), layout="constrained")
    ends: list[tuple[float, str, str]] = []
    for name, (colour, dash) in zip(names, LINES, strict=False):
        line = chosen(rows, map_name, name, None)
        top = _top(map_name, name)
        share = top if map_name == "payload" else 1.0
        ys = [y / share for y in _heights(line, top)]
        panel.plot([row["x"] for row in line], ys, color=colour, ls=dash, lw=1.8)
        ends.append((ys[-1], name, colour))
    _plain(panel)
    panel.set_xlim(0.2, 0.9)
    panel.set_ylim(0, None)
    _named(panel, ends)
    panel.set_xlabel("friction μ")
    panel.set_ylabel(what)
    figure.savefig(DOCS / "images" / f"atlas-{map_name}.svg", metadata={"Date": None})
    plt.close(figure)


def _named(panel: Axes, ends: Sequence[tuple[float, str, str]]) -> None:
    """Names beside the ends of lines, pushed apart where they meet."""
    low, high = panel.get_ylim()
    gap = (high - low) * 0.05
    at = -math.inf
    for y, name, colour in sorted(ends):
        at = max(y, at + gap)
        panel.annotate(
            name, (0.9, y), (0.915, at), color=colour, fontsize=8.5, va="center",
            annotation_clip=False, arrowprops={"arrowstyle": "-", "color": LINE, "lw": 0.6},
        )  # fmt: skip


def _top(map_name: str, robot: str) -> float:
    """The end of the searched range."""
    study = dict(studies_of(robot))[map_name]
    return float(next(axis["boundary"][1] for axis in study["axes"] if "boundary" in axis))


def tables(rows: Sequence[Row], names: Sequence[str]) -> list[str]:
    """Each map's borders with what stops the robot beyond."""
    flight = f"{STAIR['count']} steps of {STAIR['rise']} m x {STAIR['run']} m"
    return [
        "![Highest rise over tread for each robot](images/atlas-stairs.svg)",
        "Highest rise [m] of three steps, and what stops the robot at the next one asked:",
        _stairs_table(rows, names),
        "![Highest step over friction for each robot](images/atlas-step.svg)",
        "Highest single step [m]:",
        _line_table(rows, names, "step", 2),
        "![Largest payload over friction for each robot](images/atlas-payload.svg)",
        f"Largest payload [kg] up {flight}; searched up to the robot's own mass:",
        _line_table(rows, names, "payload", 1),
    ]


def _cell(row: Row, digits: int, top: float) -> str:
    beyond = row["beyond"]
    if math.isnan(row["border"]):
        return f"{top:.{digits}f}+" if math.isnan(beyond) else f"none ({_why(row)})"
    if math.isnan(beyond):
        return f"{row['border']:.{digits}f}+"
    return f"{row['border']:.{digits}f} ({_why(row)})"


def _why(row: Row) -> str:
    """What is lacking, in a word or two."""
    return str(row["needs"] or row["reason"]).split(" with ")[0]


def _stairs_table(rows: Sequence[Row], names: Sequence[str]) -> str:
    treads = (0.22, 0.26, 0.3, 0.34, 0.38)
    head = " | ".join(f"tread {tread:.2f}" for tread in treads)
    lines = [f"| robot | μ | {head} |", "|---" * (2 + len(treads)) + "|"]
    for name in names:
        for friction in SHADES:
            line = chosen(rows, "stairs", name, friction)
            found = [next(r for r in line if abs(r["x"] - tread) < 1e-9) for tread in treads]
            cells = " | ".join(_cell(row, 2, 0.94) for row in found)
            lines.append(f"| {name} | {friction:.2f} | {cells} |")
    return "\n".join(lines)


def _line_table(rows: Sequence[Row], names: Sequence[str], map_name: str, digits: int) -> str:
    frictions = (0.2, 0.3, 0.4, 0.6, 0.8)
    lines = [
        f"| robot | {' | '.join(f'μ {mu:.1f}' for mu in frictions)} |",
        "|---" * (1 + len(frictions)) + "|",
    ]
    for name in names:
        line = chosen(rows, map_name, name, None)
        cells = [
            _cell(next(r for r in line if abs(r["x"] - mu) < 1e-9), digits, _top(map_name, name))
            for mu in frictions
        ]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines)
