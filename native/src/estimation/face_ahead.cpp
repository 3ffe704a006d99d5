// The face ahead that front wheels meet while they are still on the edge before it, where nothing has made the filter unsure
// of it: a riser that comes early, against which they push until the robot's front lifts, or a tread below that is higher
// than drawn, on which they stand while on the map they are on their way down. What they feel tells.
#include "stairwright/estimation/estimator.hpp"

#include <algorithm>

#include "faces.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kExpected = 1.5;  // of the cost of a force on one face, where nothing else pushes
constexpr double kLasts = 0.05;    // s that an error of the felt force lasts
constexpr double kSurely = 10.0;   // twice the logarithm of the odds
constexpr double kDown = 0.3;      // sine of the slope of a face or edge that leads down
constexpr double kLeastRiser = 0.01, kLeastTread = 0.015;  // m that it is early; less is not worth another plan
constexpr double kMost = 0.10;     // m

}  // namespace

// A cumulative sum (Page 1954) of how much better the push of the face ahead explains the force, until the wheel is elsewhere.
void Estimator::feel_face_ahead(WheelState& w, const CurveMatch& on, const WheelBelief& belief, double dt) {
    const std::size_t next = path_.corner_from(on.s);
    w.early = {};
    if (!on.corner && !over_low_edge(w, on) && next < path_.corners().size()) {
        const double corner = path_.corners()[next];
        const Vec2 ahead = path_.normal(corner + kBeside), now = on.point.normal, off = path_.centre(corner) - belief.centre;
        const bool riser = ahead.x < -kTread && now.x > -kTread, floor = ahead.z > kTread && now.x > kDown;
        const double early = riser ? off.x : -off.z;
        if ((riser || floor) && early > (riser ? kLeastRiser : kLeastTread) && early < kMost) {
            const double odds = early / (riser ? noise_.face_place : noise_.tread_height);
            w.stopped = std::max(0.0, w.stopped + dt / kLasts * (pushed_by(belief, now, ahead) - kExpected));
            if (w.stopped > kSurely + 0.5 * odds * odds) w.early = riser ? Vec2{off.x, 0.0} : Vec2{0.0, off.z};
            return;
        }
    }
    w.stopped = 0.0;
}

std::optional<MapError> Estimator::face_ahead() const {
    const WheelState &left = wheels_[0], &right = wheels_[1];
    const Vec2 off = 0.5 * (left.early + right.early);
    if (norm(left.early) == 0.0 || norm(right.early) == 0.0) return std::nullopt;
    const double corner = path_.corners()[path_.corner_from(std::max(left.s, right.s))];
    const bool face = off.x != 0.0;
    return MapError{face, face ? corner : corner + kBeside, off, 0};
}

}  // namespace stairwright::estimation
