// When a wheel comes to another face or tread: what the map has from there on is anew unsure.
#include <algorithm>
#include <cmath>

#include "stairwright/estimation/estimator.hpp"

#include "faces.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kBend = 0.1;          // sine of the turn from one tread to the next from which on they are two

}  // namespace

// The face or tread that a wheel is on clear of others, or the edge up that is lower than it; kNoPiece if there is none.
std::size_t Estimator::clear_on(const WheelState& w, const CurveMatch& on) const {
    if (on.corner) return kNoPiece;
    if (w.low_edge && w.low_edge->first <= on.piece && on.piece <= w.low_edge->last) return w.low_edge->up ? w.low_edge->last : kNoPiece;
    const std::size_t at = face_below(on.piece);
    if (at == kNoPiece || is_low_drop(at)) return kNoPiece;
    const Piece& piece = path_.pieces()[at];
    if (piece.arc || at != on.piece) return at;  // it may be all but passed when the wheel meets it, or is round its edge
    // In a corner a wheel goes to and fro between two faces, and measures both: what is unsure is so once it has left it.
    if (std::abs(nearest_corner(on.s) - on.s) < std::min(kNearCorner, 0.5 * piece.length)) return kNoPiece;
    // Near to the edge before it the direction of its force may still tell where it is on that one, see measure_turn.
    return path_.on_arc(on.s - std::min(kClearOfEdge, 0.5 * piece.length)) ? kNoPiece : at;
}

// Every face lies and every tread is as high as the map says only more or less: what is ahead is anew unsure.
void Estimator::enter_face(int i, const CurveMatch& on) {
    WheelState& w = wheels_[i];
    if (!on.corner && face_below(on.piece) == on.piece && on.piece != w.face) w.face = on.piece, w.put_back = w.landed = 0.0;
    const std::size_t at = clear_on(w, on);
    if (at == kNoPiece || at == w.clear) return;
    const bool known = at == w.clear_before;  // it comes back to it
    w.clear_before = w.clear, w.clear = at, w.since_clear = 0.0;
    if (known) return;
    const std::size_t own = i / 2 == 0 ? kFrontOffset : kRearOffset;
    const double height = noise_.tread_height * noise_.tread_height, place = 0.5 * noise_.face_place * noise_.face_place;
    const std::size_t passed = last_face(w.clear_before, at);  // it may be too short for a wheel to be clear on
    if (w.low_edge && at == w.low_edge->last) {
        covariance_.add_noise(own + 1, height);
    } else if (is_face(at)) {
        // It may end higher or lower than drawn: down one that leans, farther on or back as well.
        covariance_.add_noise(own, {normal(at).x > 0.0 ? -across(at).z : 0.0, 1.0}, 0.5 * height);
    } else if (is_face(passed) || path_.pieces()[passed].arc) {
        if (i == 0 && is_face(passed) && !has_found(passed)) pass(passed);
        covariance_.add_noise(own, place);
        if (passed != w.clear_before) covariance_.add_noise(own + 1, 0.5 * height);  // nothing has said so yet
    } else if (std::abs(cross(normal(passed), normal(at))) > kBend) {  // a slope may rise more or less than drawn
        covariance_.add_noise(own + 1, 0.5 * height);
    }
}

}  // namespace stairwright::estimation
