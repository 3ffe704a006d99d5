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
    const auto steep = [&](std::size_t k) { return k < pieces.size() && !pieces[k].arc && is_face(k); };
    for (std::size_t k = 1; k + 1 < pieces.size(); ++k) {
        if (!pieces[k].arc) continue;
        const CurvePoint begin = pieces[k].at(0.0, path_.radius()), end = pieces[k].at(pieces[k].length, path_.radius());
        LowEdge edge{k, k, begin.normal.x < -kBend};
        if (edge.up && !path_.begins_in_corner(pieces[k]) && steep(k - 1)) edge.first = k - 1;
        if (!edge.up && steep(k + 1)) edge.last = k + 1;
        const std::size_t below = edge.last + 1;
        if (below == pieces.size() || pieces[below].arc || is_face(below)) continue;
        const Piece& last = pieces[edge.last];
        const CurvePoint to = last.at(last.length, path_.radius());
        const bool cornered = edge.up ? path_.begins_in_corner(pieces[edge.first]) : cross(to.normal, normal(below)) > kBend;
        const bool low = std::abs(pieces[edge.first].at(0.0, path_.radius()).centre.z - to.centre.z) < kHeights * noise_.tread_height;
        if (low && cornered) low_edges_.push_back(edge);
        if (!low && edge.last == k && begin.normal.z > kTread && end.normal.z < kTread && end.normal.x > 0.0) low_drops_.push_back(k);
    }
}

bool Estimator::is_low_drop(std::size_t piece) const { return std::ranges::binary_search(low_drops_, piece); }

// Whether a wheel between the begin of the one piece and the end of the other one is not clear of them yet.
bool Estimator::is_near(const WheelState& w, std::size_t first, std::size_t last) const {
    const Piece &begin = path_.pieces()[first], &below = path_.pieces()[last + 1];
    return begin.s < w.s + kWindow && w.s < below.s + std::min(kWindow, below.length) && w.clear != last + 1;
}

// Notes which low edge the wheel is near to, and that the pieces of that, or of an edge that leads down, may be none.
void Estimator::doubt_low_edges(WheelState& w, WheelBelief& belief) const {
    belief.unsure_height = noise_.tread_height * noise_.tread_height;
    const auto low = std::ranges::find_if(low_edges_, [&](const LowEdge& edge) { return is_near(w, edge.first, edge.last); });
    w.low_edge = low == low_edges_.end() ? std::nullopt : std::optional(*low);
    if (w.low_edge) {
        belief.unsure = low->first, belief.unsure_count = low->last + 2 - low->first;
    } else if (const auto drop = std::ranges::find_if(low_drops_, [&](std::size_t k) { return is_near(w, k, k); }); drop != low_drops_.end()) {
        belief.unsure = *drop + 1, belief.unsure_count = 1;
    }
}

// Up an edge that is there a wheel feels it, and measures it. The corner at the foot of one that leads down lies the nearer to
// it the lower that is.
bool Estimator::over_low_edge(const WheelState& w, const CurveMatch& on) const {
    if (!w.low_edge) return false;
    const auto [first, last, up] = *w.low_edge;
    if (on.corner) return !up && on.s > path_.pieces()[first].s && on.s <= path_.pieces()[last + 1].s;
    return on.piece == last + 1 || (!up && first <= on.piece && on.piece <= last);
}

// A wheel that is clear of it measures how high that tread is, of which nothing was known; but where the wheel has felt the
// edge on its way up, the height and its place there are what that can be told from.
void Estimator::leave_low_edge(int i, const CurveMatch& on, const WheelPlace& place, Error& error) {
    WheelState& w = wheels_[i];
    if (!w.low_edge || w.clear != w.low_edge->last + 1) return;
    const bool felt = w.clear_before == w.low_edge->last;
    w.low_edge.reset();
    if (felt) return;
    covariance_.add_noise((i / 2 == 0 ? kFrontOffset : kRearOffset) + 1, noise_.tread_height * noise_.tread_height);
    covariance_.update(place.along_z, on.point.centre.z - place.centre.z, noise_.place * noise_.place, error);
}

}  // namespace stairwright::estimation
