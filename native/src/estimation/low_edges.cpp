// Edges that a wheel passes without a face: from tread to tread there is nothing but an arc.
//
// Those that lead down or up by no more than what heights may be off: they may be none, and where one is none it must not be
// taken for one that comes later. Until a wheel is clear of it on the tread behind it, only its rolling says where it is.
#include <algorithm>
#include <cmath>

#include "stairwright/estimation/estimator.hpp"

#include "faces.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kHeights = 3.5;  // standard deviations of a tread's height: an edge as low as that may be none
constexpr double kBend = 0.3;     // sine of a turn; less is no more than a bend of the ground

}  // namespace

void Estimator::note_low_edges() {
    low_edges_.clear(), low_drops_.clear();
    const auto& pieces = path_.pieces();
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
        if (!pieces[k].arc || pieces[k + 1].arc || is_face(k + 1)) continue;
        const CurvePoint begin = pieces[k].at(0.0, path_.radius()), end = pieces[k].at(pieces[k].length, path_.radius());
        const bool down = cross(end.normal, normal(k + 1)) > kBend;
        const bool low = std::abs(begin.centre.z - end.centre.z) < kHeights * noise_.tread_height;
        if (low && (down || leads_up(k))) low_edges_.push_back(k);
        if (!low && begin.normal.z > kTread && end.normal.z < kTread && end.normal.x > 0.0) low_drops_.push_back(k);
    }
}

bool Estimator::leads_up(std::size_t edge) const {
    return std::ranges::binary_search(path_.corners(), path_.pieces()[edge].s) && normal(edge).x < -kBend;
}

bool Estimator::is_low_drop(std::size_t piece) const { return std::ranges::binary_search(low_drops_, piece); }

// The one near to a wheel that is not clear of it yet.
std::size_t Estimator::next_edge(const std::vector<std::size_t>& edges, const WheelState& w) const {
    for (const std::size_t k : edges) {
        const Piece &edge = path_.pieces()[k], &below = path_.pieces()[k + 1];
        if (edge.s < w.s + kWindow && w.s < below.s + std::min(kWindow, below.length) && w.clear != k + 1) return k;
    }
    return kNoPiece;
}

// Up an edge that is there a wheel feels it, and measures it. The corner at the foot of one that leads down lies the nearer to
// it the lower that is.
bool Estimator::over_low_edge(const WheelState& w, const CurveMatch& on) const {
    if (w.low_edge == kNoPiece) return false;
    if (on.corner) return !leads_up(w.low_edge) && on.s > path_.pieces()[w.low_edge].s && on.s <= path_.pieces()[w.low_edge + 1].s;
    return on.piece == w.low_edge + 1 || (on.piece == w.low_edge && !leads_up(on.piece));
}

// A wheel that is clear of it measures how high that tread is, of which nothing was known; but where the wheel has felt the
// edge on its way up, the height and its place there are what that can be told from.
void Estimator::leave_low_edge(int i, const CurveMatch& on, const Error& along_z, Vec2 centre, Error& error) {
    WheelState& w = wheels_[i];
    if (w.low_edge == kNoPiece || w.clear != w.low_edge + 1) return;
    const bool felt = w.clear_before == w.low_edge;
    w.low_edge = kNoPiece;
    if (felt) return;
    covariance_.add_noise((i / 2 == 0 ? kFrontOffset : kRearOffset) + 1, noise_.tread_height * noise_.tread_height);
    covariance_.update(along_z, on.point.centre.z - centre.z, noise_.place * noise_.place, error);
}

}  // namespace stairwright::estimation
