"""Where poses are needed: the obstacles of a profile, and two wheel places for each.

On the paper's terrain an obstacle is a stair or a ramp. On any profile it is what the wheel centre
climbs or descends between two treads: a tread is a stretch of the wheel-centre curve at least
0.1 m long whose slope stays below 3 degrees; between two treads every rise or descent of at least
20 mm (smaller ups and downs within it ignored) is an obstacle. One that goes up and down again is
two. A flight whose treads are not level is one obstacle for each of its faces; one whose treads are
too short for a tread is one obstacle.
"""

from __future__ import annotations

from dataclasses import dataclass

from stairwright import _core
from stairwright.terrain.wheel_path import WheelPath


@dataclass(frozen=True)
class Obstacle:
    """One rise or descent of the wheel centre. Lengths in m.

    Attributes:
        begin: Arc length where the curve leaves the tread before it: the front wheel arrives at
            the face (eq 25).
        end: Arc length where the next tread is reached.
        height: Gained, or lost where negative (h of eq 26).
        face: h / sin(gamma), gamma the steepest slope of the wheel's way.
        steepest: Arc length of the last place that is as steep.
    """

    begin: float
    end: float
    height: float
    face: float
    steepest: float

    def same_as(self, other: Obstacle) -> bool:
        """Whether the other is as high and as long, to a tenth of a millimetre."""
        return (
            abs(self.height - other.height) < 1e-4
            and abs((self.end - self.begin) - (other.end - other.begin)) < 1e-4
        )


def find_obstacles(path: WheelPath, low: float, high: float) -> list[Obstacle]:
    """Obstacles between the arc lengths `low` and `high`, in order."""
    found = _core.find_obstacles(path.native, low, high)
    return [Obstacle(o.begin, o.end, o.height, o.face, o.steepest) for o in found]


def front_places(
    obstacles: list[Obstacle], radius: float, begin: float, end: float
) -> list[tuple[float, float]]:
    """Arc lengths of the front wheel at the two poses of each obstacle.

    The first: at the face, or where the wheel stands on it already. The second, as eq 26 has it: a
    face and a wheel radius further, at least over the edge, but never past the next face or `end`.

    Args:
        obstacles: In order.
        radius: Of the wheels [m].
        begin: Where the front wheel starts [m].
        end: Where it comes to rest [m].
    """
    places = []
    for k, obstacle in enumerate(obstacles):
        following = obstacles[k + 1].begin if k + 1 < len(obstacles) else end
        first = max(obstacle.begin, begin)
        second = max(obstacle.end, obstacle.begin + obstacle.face + radius)
        places.append((first, max(min(second, following), first + 1e-4)))
    return places
