// A riser that comes so early that front wheels meet it on the edge before, where nothing has made them unsure of it yet:
// they stand, push and lift the robot's front, while on the map they are on their way to it. What they feel tells.
#include "stairwright/estimation/estimator.hpp"

#include <cmath>

#include "faces.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kExpected = 1.5;   // of the cost of a force on one face, where nothing else pushes
constexpr double kLasts = 0.05;     // s that an error of the felt force lasts
constexpr double kSurely = 10.0;    // twice the logarithm of the odds
constexpr double kMostEarly = 0.10, kLeastEarly = 0.01;  // m

}  // namespace

// A cumulative sum (Page 1954) of how much better the riser's push explains the force, until the wheel is elsewhere.
void Estimator::feel_early_riser(WheelState& w, const CurveMatch& on, const WheelBelief& belief, double dt) {
    const std::size_t next = path_.corner_from(on.s);
    w.early = 0.0;
    if (!on.corner && next < path_.corners().size()) {
        const double corner = path_.corners()[next];
        const Vec2 riser = path_.normal(corner + 1e-6);
        const double early = path_.centre(corner).x - belief.centre.x;
        if (riser.x < -kTread && on.point.normal.x > -kTread && early > kLeastEarly && early < kMostEarly) {
            const double off = early / noise_.face_place;
            w.early = early;
            w.stopped = std::max(0.0, w.stopped + dt / kLasts * (pushed_by(belief, on.point.normal, riser) - kExpected));
            if (w.stopped < kSurely + 0.5 * off * off) w.early = 0.0;
            return;
        }
    }
    w.stopped = 0.0;
}

std::optional<MapError> Estimator::early_riser() const {
    const WheelState &left = wheels_[0], &right = wheels_[1];
    if (left.early == 0.0 || right.early == 0.0) return std::nullopt;
    const std::size_t next = path_.corner_from(std::max(left.s, right.s));
    return MapError{true, path_.corners()[next], {0.5 * (left.early + right.early), 0.0}, 0};
}

}  // namespace stairwright::estimation
