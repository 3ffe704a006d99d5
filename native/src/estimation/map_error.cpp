// Where the map is wrong: what the front wheels find differs from it, and is settled.
#include "stairwright/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::estimation {

namespace {

constexpr double kSteep = 0.7;      // cosine of the slope below which a face is no tread
constexpr double kSettled = 0.12;   // s that wheels must be on a face before its place counts as found
constexpr double kLeastFace = 0.008, kLeastTread = 0.006;  // m; less is not worth another plan

}  // namespace

void Estimator::compare_with_map(int i, const CurveMatch& on, double dt) {
    WheelState& w = wheels_[i];
    const bool felt = estimate_.touching[i] && (on.corner || !path_.pieces()[on.piece].arc);
    const bool face = on.corner || on.point.normal.z < kSteep;
    if (!felt || face != w.on_face) w.known = 0.0;
    w.on_face = face;
    if (felt) w.known += dt;
}

void Estimator::find_map_error() {
    estimate_.map_error.reset();
    const WheelState &left = wheels_[0], &right = wheels_[1];
    if (std::min(left.known, right.known) < kSettled || left.on_face != right.on_face || left.missed || right.missed) return;
    const double off = left.on_face ? offset_[0].x : offset_[0].z;
    if (std::abs(off) < (left.on_face ? kLeastFace : kLeastTread)) return;
    estimate_.map_error = MapError{left.on_face, 0.5 * (left.s + right.s), offset_[0]};
}

void Estimator::correct_map(WheelPath path, const MapError& found) {
    path_ = std::move(path);
    (found.face ? offset_[0].x : offset_[0].z) -= found.face ? found.off.x : found.off.z;
    for (int i = 0; i < 4; ++i) {
        WheelState& w = wheels_[i];
        w.s = path_.project(place_ + offset_[i / 2] + w.leg.wheel, 0.0, path_.length());
        w.put_back = w.known = 0.0, w.met = -1e9;
        const auto& pieces = path_.pieces();
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (!pieces[k].arc && pieces[k].s <= w.s) w.face = w.face_before = k;
    }
    estimate_.map_error.reset();
}

}  // namespace stairwright::estimation
