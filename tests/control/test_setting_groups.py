"""Every setting stands under a heading, and what has no effect is not offered."""

from __future__ import annotations

import pytest

from stairwright.control.settings import GROUPS as CONTROLLER
from stairwright.control.settings import ControllerSettings
from stairwright.documents import Model
from stairwright.planning.weights import CriticalWeights, PathWeights
from stairwright.simulation.disturbance import GROUPS as DISTURBANCE
from stairwright.simulation.disturbance import Disturbance


@pytest.mark.parametrize(
    ("model", "groups"), [(ControllerSettings, CONTROLLER), (Disturbance, DISTURBANCE)]
)
def test_every_setting_has_a_heading_and_a_name(
    model: type[Model], groups: dict[str, tuple[str, ...]]
) -> None:
    properties = model.model_json_schema(by_alias=True)["properties"]
    assert {name: each["group"] for name, each in properties.items()} == {
        name: group for group, names in groups.items() for name in names
    }
    titles = [each["title"] for each in properties.values()]
    assert len(set(titles)) == len(titles)


def test_ranges_for_hands_lie_within_the_bounds() -> None:
    properties = Disturbance.model_json_schema()["properties"]
    ranges = {name: each["slider"] for name, each in properties.items() if "slider" in each}
    assert "friction" in ranges
    for name, (low, high) in ranges.items():
        assert properties[name]["minimum"] <= low < high < properties[name]["maximum"]


def test_speed_is_a_weight_of_steady_timing_alone() -> None:
    speed = PathWeights.model_json_schema()["properties"]["speed"]
    assert speed["timing"] == "steady"
    assert "timing" not in CriticalWeights.model_json_schema()["properties"]["speed"]
