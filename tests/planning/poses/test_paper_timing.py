import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.poses.paper_timing import pose_times, time_over_face, time_to_face


def test_equations_25_and_26():
    assert time_to_face(0.5, 0.05, 0.1) == pytest.approx(4.5)
    assert time_over_face(0.36, 0.05, 0.1) == pytest.approx(4.1)


@pytest.mark.parametrize(("terrain", "face"), [("single-stair-036", 0.36), ("ramp-30deg-025", 0.5)])
def test_plan_times_are_the_papers(terrain, face):
    speed, radius = 0.12, 0.05
    plan = sw.plan(terrain, method="critical", weights={"speed": speed})
    start, first, second = plan.poses[:3]
    assert plan.timing.rule == "paper"
    assert plan.timing.total == plan.poses[-1].time
    # On the level the wheel's way is Δx - R, Δx from its centre to where it touches the face.
    way = first.wheel_progress[0] - start.wheel_progress[0]
    assert first.time == pytest.approx(time_to_face(way + radius, radius, speed))
    assert second.time - first.time == pytest.approx(time_over_face(face, radius, speed), rel=1e-6)


def test_longest_way_counts():
    wheels = np.array([[1.0, 0.8], [1.1, 1.0], [1.4, 1.1]])
    assert pose_times(wheels, 0.1) == pytest.approx([0.0, 2.0, 5.0])
