// Where the map is wrong: what the front wheels find differs from it, and is settled.
#include "stairwright/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "faces.hpp"

namespace stairwright::estimation {

namespace {

constexpr double kSettled = 0.12;   // s that wheels must be on a face before its place counts as found
constexpr double kPassed = 0.015;   // m; how well front wheels must know where they are on a face that they have passed
constexpr double kRecalled = 0.006;  // m; how well rear wheels know what front wheels found
constexpr double kReach = 0.5;  // m along the curve that a face or tread is looked for
constexpr double kInto = 0.02;  // m that a wheel must be on a face or tread
constexpr double kSameGround = 1e-3;  // m
constexpr double kLeastFace = 0.008, kLeastEdge = 0.02, kLeastTread = 0.006;  // m; less is not worth another plan

}  // namespace

void Estimator::compare_with_map(int i, const CurveMatch& on, const Spread& spread, double dt) {
    WheelState& w = wheels_[i];
    const Piece& piece = path_.pieces()[on.piece];
    // An edge that leads down tells where the face below it is, once the wheel is round it beyond doubt.
    const double sure = kBeyondDoubt * std::sqrt(spread.along({on.point.normal.z, -on.point.normal.x}));
    const auto edge = path_.next_drop(on.s);
    const bool drop = !on.corner && piece.arc && edge && *edge <= on.s && on.s > piece.s + sure;
    const bool felt = estimate_.touching[i] && !over_low_edge(w, on) && (on.corner || drop || !piece.arc);
    // A riser once felt, by this wheel or the one beside it, is known as long as it stays there (see measure_place), but not
    // while the rear ones climb: a robot that hangs between two risers must not wait for another plan.
    const double corner = nearest_corner(on.s);
    const bool at_riser = (w.met == corner || wheels_[i ^ 1].met == corner) && std::abs(on.s - corner) < kNearCorner &&
                          estimate_.on_tread[1];
    const bool face = on.corner || drop || at_riser || on.point.normal.z < kTread;
    if (!felt || face != w.on_face) w.known = 0.0;
    w.on_face = face;
    if (felt) w.known += dt;
}

void Estimator::find_map_error() {
    estimate_.map_error = face_ahead();
    if (estimate_.map_error) return;
    const WheelState &left = wheels_[0], &right = wheels_[1];
    if (std::min(left.known, right.known) < kSettled || left.on_face != right.on_face || left.missed || right.missed) return;
    const double s = 0.5 * (left.s + right.s);
    const std::size_t at = face_or_tread(s, left.on_face);
    if (at >= path_.pieces().size()) return;
    if (left.on_face && !has_found(at)) believe_map(at);
    const double off = dot(across(at), offset_[0]);
    found_.resize(path_.pieces().size());
    found_[at] = off;
    if (!left.on_face) settled_ = off;
    for (const int rear : {2, 3}) recall(wheels_[rear]);  // whether they know of it is in the map error
    const double least = path_.on_arc(left.s) ? kLeastEdge : left.on_face ? kLeastFace : kLeastTread;
    if (std::abs(off) < least) return;
    estimate_.map_error = MapError{left.on_face, s, left.on_face ? Vec2{off, 0.0} : Vec2{0.0, off}, rear_knows(s, left.on_face) ? 2 : 1};
}

// Whether what front wheels found at `s` is in the rear wheels' offset, too.
bool Estimator::rear_knows(double s, bool face) const {
    const Vec2 front = path_.at(s).centre, rear = path_.at(0.5 * (wheels_[2].s + wheels_[3].s)).centre;
    if (std::abs(face ? front.x - rear.x : front.z - rear.z) < kSameGround) return true;
    const std::size_t found = face_or_tread(s, face);
    const auto told = [&](const WheelState& w) { return found > 0 && (w.told[0] == found || w.told[1] == found); };
    return told(wheels_[2]) || told(wheels_[3]);
}

// What of an offset counts for a face along, or for a tread up. A face that leans is the same one a little higher and farther
// on or back.
Vec2 Estimator::across(std::size_t piece) const {
    if (!is_face(piece)) return {0.0, 1.0};
    const Vec2 n = normal(piece);
    return {1.0, path_.pieces()[piece].arc ? 0.0 : n.z / n.x};
}

Vec2 Estimator::normal(std::size_t piece) const { return path_.pieces()[piece].at(0.0, path_.radius()).normal; }

bool Estimator::is_face(std::size_t piece) const { return normal(piece).z < kTread || is_low_drop(piece); }

// The face or tread that a wheel on that piece of the curve is on. Round an edge that leads up it is still the face below;
// one that is lower than the wheel has nothing but the edge.
std::size_t Estimator::face_below(std::size_t piece) const {
    const Piece& edge = path_.pieces()[piece];
    if (!edge.arc || is_low_drop(piece)) return piece;
    if (!is_face(piece) || normal(piece).x > 0.0) return kNoPiece;
    if (piece > 0 && !path_.pieces()[piece - 1].arc && is_face(piece - 1)) return piece - 1;
    return path_.begins_in_corner(edge) ? piece : kNoPiece;
}

// The last face between two pieces, `from` if there is none. That of a low edge down nothing measures.
std::size_t Estimator::last_face(std::size_t from, std::size_t to) const {
    for (std::size_t k = to; k > from + 1; --k) {
        const auto down = [&](const LowEdge& edge) { return !edge.up && edge.first <= k - 1 && k - 1 <= edge.last; };
        if (face_below(k - 1) == k - 1 && is_face(k - 1) && std::ranges::none_of(low_edges_, down)) return k - 1;
    }
    return from;
}

std::size_t Estimator::face_or_tread(double s, bool face) const {
    const auto& pieces = path_.pieces();
    std::size_t best = pieces.size();
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (pieces[k].s > s + kReach) break;
        if (face_below(k) != k || pieces[k].s + pieces[k].length < s - kReach || is_face(k) != face) continue;
        const double away = std::max({pieces[k].s - s, s - pieces[k].s - pieces[k].length, 0.0});
        if (away < nearest) nearest = away, best = k;
    }
    return best;
}

// What front wheels say of a face once, when they have found it or passed it. Each is off by itself, the one as likely
// ahead as the other behind: what all of them seem to be off the robot's place is. The difference between two faces has
// twice the variance of either.
void Estimator::believe_map(std::size_t face) {
    const Vec2 across = this->across(face);
    Error error{}, row{};
    row[kFrontOffset] = across.x, row[kFrontOffset + 1] = across.z;
    covariance_.update(row, -dot(across, offset_[0]), 0.5 * noise_.face_place * noise_.face_place, error);
    // Where the wheels are on the map, and what they have found there, stays.
    for (const std::size_t k : {0, 1}) error[kFrontOffset + k] = error[kRearOffset + k] = -error[kPlace + k];
    for (std::size_t k = 0; k < found_.size(); ++k)
        if (found_[k] && is_face(k)) *found_[k] -= error[kPlace];
    correct(error);
}

// Front wheels are past a face on which they have not stayed for long, such as an edge that is lower than they.
void Estimator::pass(std::size_t face) {
    believe_map(face);
    const double variance = covariance_(kPlace, kPlace) + 2.0 * covariance_(kPlace, kFrontOffset) + covariance_(kFrontOffset, kFrontOffset);
    if (variance > kPassed * kPassed) return;
    found_.resize(path_.pieces().size());
    found_[face] = dot(across(face), offset_[0]);
}

// Of the tread that a rear wheel is on and of the face behind it, or the other way round; not while it may still lean on the
// one before, and of the face not before it is the nearer one: what that is off says nothing of the edge behind the wheel,
// which the plan would have it roll back over. Where a tread follows another one, how high that is says nothing yet.
void Estimator::recall(WheelState& rear) {
    const Piece& now = path_.pieces()[rear.face];
    if (rear.s < now.s + std::min(kInto, 0.5 * now.length) || rear.s > now.s + now.length) return;
    if (rear.face != rear.recalled) rear.recalled = rear.face, rear.told = {};
    Error error{};
    bool news = false;
    std::size_t seen = 0;
    for (std::size_t k = rear.face; k < found_.size() && seen < rear.told.size(); ++k) {
        if (face_below(k) != k) continue;
        if (seen++ > 0 && (is_face(k) == is_face(rear.face) || (is_face(k) && rear.s < now.s + 0.5 * now.length))) break;
        if (!found_[k] || rear.told[seen - 1] == k) continue;
        rear.told[seen - 1] = k, news = true;
        const Vec2 across = this->across(k);
        Error row{};
        row[kRearOffset] = across.x, row[kRearOffset + 1] = across.z;
        covariance_.update(row, *found_[k] - dot(across, offset_[1]), kRecalled * kRecalled, error);
    }
    if (news) correct(error);
}

// Where all four wheels are on the landing, past the last face, what that is off is the same for both pairs. Before, front wheels
// may have news of the face ahead already.
void Estimator::come_to_landing() {
    const std::size_t piece = wheels_[0].clear;
    if (landed_ || is_face(piece) || last_face(piece, path_.pieces().size()) != piece) return;
    if (std::ranges::any_of(wheels_, [&](const WheelState& w) { return w.clear != piece; })) return;
    landed_ = true;
    Error error{}, row{};
    row[kFrontOffset] = 1.0, row[kRearOffset] = -1.0;
    covariance_.update(row, offset_[1].x - offset_[0].x, kRecalled * kRecalled, error);
    correct(error);
}

Vec2 Estimator::correct_map(WheelPath path, const MapError& found) {
    const Vec2 by = found.off;
    // A face is moved by itself, with a tread all that is behind it.
    const std::size_t first = face_or_tread(found.s, found.face);
    if (path.pieces().size() != found_.size()) found_.clear();
    for (std::size_t k = first; k < found_.size(); ++k)
        if (found_[k] && is_face(k) == found.face && (k == first || !found.face)) *found_[k] -= found.face ? by.x : by.z;
    path_ = std::move(path);
    note_low_edges();
    for (int pair = 0; pair < found.pairs; ++pair) offset_[pair] = offset_[pair] - by;
    settled_ -= by.z;
    for (int i = 0; i < 4; ++i) {
        WheelState& w = wheels_[i];
        w.s = path_.project(place_ + offset_[i / 2] + w.leg.wheel, 0.0, path_.length());
        w.put_back = w.known = w.stopped = w.since_clear = 0.0, w.met = -1e9, w.recalled = 0, w.told = {};
        const auto& pieces = path_.pieces();
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (!pieces[k].arc && pieces[k].s <= w.s) w.face = w.clear = w.clear_before = k;
    }
    estimate_.map_error.reset();
    return (-0.5 * found.pairs) * by;
}

}  // namespace stairwright::estimation
