#include "stairwright/wheel_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace stairwright {

namespace {

using std::numbers::pi;

constexpr double kShortest = 1e-9;  // m; shorter pieces are dropped
constexpr double kKink = 1e-3;      // rad; a larger jump of the normal towards the wheel is a concave corner
constexpr double kSteep = 0.7;  // x of a face's normal that is no tread
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Offset segments and the arcs between them, untrimmed; their arc lengths are still 0.
std::vector<Piece> offset_pieces(const std::vector<Vec2>& p, double r) {
    std::vector<Piece> out;
    out.reserve(2 * p.size());
    Vec2 before;  // direction of the segment before
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
        const Vec2 d = p[i + 1] - p[i];
        const double length = std::hypot(d.x, d.z);  // exact along an axis, unlike norm()
        if (length == 0.0) throw std::invalid_argument("a point of the profile is repeated");
        const Vec2 t = {d.x / length, d.z / length};
        double turn = i > 0 ? std::atan2(cross(before, t), dot(before, t)) : 0.0;
        if (std::abs(std::abs(turn) - pi) < 1e-9) turn = -pi;  // the tip of a zero-width spike (slits are closed beforehand)
        if (turn < -1e-12) out.push_back({true, 0.0, -turn * r, p[i], std::atan2(before.x, -before.z), 0.0});
        out.push_back({false, 0.0, length, {p[i].x - r * t.z, p[i].z + r * t.x}, t.x, t.z});
        before = t;
    }
    return out;
}

std::array<double, 2> bounds(const Piece& piece, double r) {
    if (piece.arc) return {piece.origin.x - r, piece.origin.x + r};
    const double end = piece.origin.x + piece.length * piece.a;
    return {std::min(piece.origin.x, end), std::max(piece.origin.x, end)};
}

// Intersections of the full line or circle of `a` with those of `b`; returns their number.
int crossings(const Piece& a, const Piece& b, double r, std::array<Vec2, 2>& out) {
    if (!a.arc && !b.arc) {
        const double det = a.a * b.b - a.b * b.a;
        if (std::abs(det) < 1e-12) return 0;
        const Vec2 d = b.origin - a.origin;
        const double u = (d.x * b.b - d.z * b.a) / det;
        out[0] = {a.origin.x + u * a.a, a.origin.z + u * a.b};
        return 1;
    }
    if (a.arc && b.arc) {
        const Vec2 d = b.origin - a.origin;
        const double gap = std::hypot(d.x, d.z);
        if (gap < 1e-12 || gap >= 2 * r) return 0;
        const double h = std::sqrt(r * r - gap * gap / 4);
        for (int k = 0; k < 2; ++k) {
            const double side = k == 0 ? h : -h;
            out[k] = {(a.origin.x + b.origin.x) / 2 - side * d.z / gap, (a.origin.z + b.origin.z) / 2 + side * d.x / gap};
        }
        return 2;
    }
    const Piece &line = a.arc ? b : a, &arc = a.arc ? a : b;
    const Vec2 o = line.origin - arc.origin;
    const double along = o.x * line.a + o.z * line.b;
    const double discriminant = along * along - (o.x * o.x + o.z * o.z - r * r);
    if (discriminant <= 0) return 0;
    for (int k = 0; k < 2; ++k) {
        const double u = -along + (k == 0 ? std::sqrt(discriminant) : -std::sqrt(discriminant));
        out[k] = {line.origin.x + u * line.a, line.origin.z + u * line.b};
    }
    return 2;
}

// Cut every raw piece at every crossing; keep the parts that are `r` away from the terrain.
std::vector<Piece> trim(const std::vector<Piece>& raw, const Terrain& terrain, double r) {
    if (!(r > 0.0 && std::isfinite(r))) throw std::invalid_argument("the wheel's radius must be above 0");
    const std::size_t n = raw.size();
    std::vector<double> lo(n), hi(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto [low, high] = bounds(raw[i], r);
        lo[i] = low, hi[i] = high;
    }
    // Raw order follows x up to the wheel's diameter: a running maximum bounds the search.
    std::vector<double> reach = hi, ahead = lo, cuts;
    for (std::size_t i = 1; i < n; ++i) reach[i] = std::max(reach[i], reach[i - 1]);
    for (std::size_t i = n - 1; i-- > 0;) ahead[i] = std::min(ahead[i], ahead[i + 1]);
    std::vector<Piece> out;
    std::array<Vec2, 2> points;
    double s = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        cuts.assign({0.0, raw[i].length});
        auto j = static_cast<std::size_t>(std::lower_bound(reach.begin(), reach.end(), lo[i] - 1e-9) - reach.begin());
        for (; j < n && ahead[j] <= hi[i] + 1e-9; ++j) {
            if (j == i || lo[j] > hi[i] + 1e-9 || hi[j] < lo[i] - 1e-9) continue;
            const int count = crossings(raw[i], raw[j], r, points);
            for (int m = 0; m < count; ++m) {
                const double u = raw[i].parameter(points[m], r), v = raw[j].parameter(points[m], r);
                if (kShortest < u && u < raw[i].length - kShortest && -1e-9 <= v && v <= raw[j].length + 1e-9)
                    cuts.push_back(u);
            }
        }
        std::sort(cuts.begin(), cuts.end());
        double begin = -1.0;
        for (std::size_t m = 0; m < cuts.size(); ++m) {
            bool kept = false;
            if (m + 1 < cuts.size()) {
                if (cuts[m + 1] - cuts[m] <= kShortest) continue;
                const Vec2 c = raw[i].at(0.5 * (cuts[m] + cuts[m + 1]), r).centre;
                kept = terrain.distance(c, r + 1e-6) > r - 1e-7 && c.z > terrain.height(c.x);
            }
            if (kept && begin < 0) {
                begin = cuts[m];
            } else if (!kept && begin >= 0) {
                Piece piece = raw[i];
                piece.s = s, piece.length = cuts[m] - begin;
                if (piece.arc)
                    piece.a -= begin / r;
                else
                    piece.origin = raw[i].at(begin, r).centre;
                s += piece.length;
                out.push_back(piece);
                begin = -1.0;
            }
        }
    }
    return out;
}

std::vector<double> concave_corners(const std::vector<Piece>& pieces, double r) {
    std::vector<double> out;
    for (std::size_t k = 1; k < pieces.size(); ++k) {
        const Vec2 a = pieces[k - 1].at(pieces[k - 1].length, r).normal, b = pieces[k].at(0.0, r).normal;
        if (cross(a, b) > kKink) out.push_back(pieces[k].s);  // the normal jumps anticlockwise: a dent
    }
    return out;
}

}  // namespace

double Piece::parameter(Vec2 p, double radius) const {
    if (!arc) return (p.x - origin.x) * a + (p.z - origin.z) * b;
    double turn = a - std::atan2(p.z - origin.z, p.x - origin.x);
    turn -= 2 * pi * std::floor((turn + pi / 2) / (2 * pi));
    return radius * turn;
}

WheelPath::WheelPath(const std::vector<Vec2>& vertices, double radius)
    : terrain_(vertices), pieces_(trim(offset_pieces(vertices, radius), terrain_, radius)), corners_(concave_corners(pieces_, radius)), radius_(radius) {
    if (pieces_.empty()) throw std::invalid_argument("the profile is too short for the wheel");
    for (const Piece& piece : pieces_) starts_.push_back(piece.s);
}

std::size_t WheelPath::piece(double s) const {
    const auto k = std::upper_bound(starts_.begin(), starts_.end(), s) - starts_.begin();
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(k - 1, 0));
}

std::optional<double> WheelPath::next_drop(double s) const {
    for (std::size_t k = piece(s); k < pieces_.size() && pieces_[k].s < s + kEarlyDrop; ++k)
        if (pieces_[k].arc && pieces_[k].at(pieces_[k].length, radius_).normal.x > kSteep) return pieces_[k].s;
    return std::nullopt;
}

double WheelPath::turn(double a, double b) const {
    double rolled = 0.0;
    for (std::size_t k = piece(a); k < pieces_.size() && pieces_[k].s < b; ++k) {
        const Piece& one = pieces_[k];
        if (one.arc) rolled += std::max(0.0, std::min(b, one.s + one.length) - std::max(a, one.s));
    }
    return rolled / radius_;
}

std::size_t WheelPath::corner_from(double s) const {
    return static_cast<std::size_t>(std::lower_bound(corners_.begin(), corners_.end(), s) - corners_.begin());
}

bool WheelPath::begins_in_corner(const Piece& piece) const { return std::binary_search(corners_.begin(), corners_.end(), piece.s); }

double WheelPath::project(Vec2 p, double lower, double upper) const {
    double best = kInfinity, found = lower;
    for (std::size_t k = piece(lower); k < pieces_.size() && pieces_[k].s <= upper; ++k) {
        const Piece& piece = pieces_[k];
        const double low = std::max(0.0, lower - piece.s), high = std::min(piece.length, upper - piece.s);
        const double d = std::min(std::max(piece.parameter(p, radius_), low), high);
        const Vec2 e = piece.at(d, radius_).centre - p;
        if (dot(e, e) < best) best = dot(e, e), found = piece.s + d;
    }
    return found;
}

}  // namespace stairwright
