import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.poses.paper_timing import pose_times


def time_to_face(distance, radius, speed):
    """Eq 25: until the front wheel touches a face `distance` ahead of its centre."""
    return (distance - radius) / speed


def time_over_face(face, radius, speed):
    """Eq 26: from there until the wheel has passed a face of length h / sin(gamma)."""
    return (face + radius) / speed


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
