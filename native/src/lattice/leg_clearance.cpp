#include "stairwright/lattice/leg_clearance.hpp"

#include <algorithm>
#include <cmath>

#include "stairwright/simd.hpp"

namespace stairwright::lattice {

namespace {

struct Point {
    float x, z;
};

STAIRWRIGHT_INLINE Point operator+(Point a, Point b) { return {a.x + b.x, a.z + b.z}; }
STAIRWRIGHT_INLINE Point operator-(Point a, Point b) { return {a.x - b.x, a.z - b.z}; }
STAIRWRIGHT_INLINE float cross(Point a, Point b) { return a.x * b.z - a.z * b.x; }
STAIRWRIGHT_INLINE float square(Point a) { return a.x * a.x + a.z * a.z; }
STAIRWRIGHT_INLINE float least(float a, float b) { return a < b ? a : b; }
STAIRWRIGHT_INLINE float most(float a, float b) { return a > b ? a : b; }

// Squared distance of a point from the segment a + t d, with 1 / |d|^2 given.
STAIRWRIGHT_INLINE float to_segment(Point p, Point a, Point d, float inverse) {
    const Point e = p - a;
    const float t = least(1.0F, most(0.0F, (e.x * d.x + e.z * d.z) * inverse));
    return square({e.x - t * d.x, e.z - t * d.z});
}

// Squared distance of the segments a-b and c-d, 0 where they cross; 1 / length^2 of both given.
STAIRWRIGHT_INLINE float segments(Point a, Point b, Point c, Point d, float first, float second) {
    const Point u = b - a, v = d - c;
    const float s1 = cross(u, c - a), s2 = cross(u, d - a), s3 = cross(v, a - c), s4 = cross(v, b - c);
    const float near = least(least(to_segment(a, c, v, second), to_segment(b, c, v, second)),
                             least(to_segment(c, a, u, first), to_segment(d, a, u, first)));
    return most(s1 * s2, s3 * s4) < 0.0F ? 0.0F : near;
}

// A leg in single precision, and what follows from its lengths.
struct SingleLeg {
    Point hip;
    float thigh, calf;                  // squared lengths
    float inverse_thigh, inverse_calf;  // of those
    float knee;

    explicit SingleLeg(const Leg& leg)
        : hip{static_cast<float>(leg.hip.x), static_cast<float>(leg.hip.z)},
          thigh(static_cast<float>(leg.thigh.length * leg.thigh.length)),
          calf(static_cast<float>(leg.calf.length * leg.calf.length)),
          inverse_thigh(1.0F / thigh), inverse_calf(1.0F / calf), knee(static_cast<float>(leg.knee)) {}
};

// The knee of a leg with its hip at `hip` and its wheel at `wheel`.
STAIRWRIGHT_INLINE Point knee_point(float thigh, float calf, float side, Point hip, Point wheel) {
    const Point e = wheel - hip;
    const float d = square(e), inverse = 1.0F / d, m = 0.5F * (thigh - calf + d) * inverse;
    const float n = side * std::sqrt(most(0.0F, thigh * inverse - m * m));
    return {hip.x + m * e.x - n * e.z, hip.z + m * e.z + n * e.x};
}

// Squared distances that the parts' middle lines keep.
struct Distances {
    float thighs, thigh_calf, calf_thigh, calves;  // front part first
    float front_wheel_thigh, front_wheel_calf, rear_wheel_thigh, rear_wheel_calf;
};

double radius(const Link& link) {
    double out = 0.0;
    for (const Capsule& c : link.shape) out = std::max(out, c.radius);
    return out;
}

Distances distances(const Leg& front, const Leg& rear, double distance) {
    const auto kept = [&](double a, double b) {
        const double sum = std::max(0.0, a + b + distance);
        return static_cast<float>(sum * sum);
    };
    const double ft = radius(front.thigh), fc = radius(front.calf), rt = radius(rear.thigh), rc = radius(rear.calf);
    const double fw = front.wheel.radius, rw = rear.wheel.radius;
    return {kept(ft, rt), kept(ft, rc), kept(fc, rt), kept(fc, rc), kept(fw, rt), kept(fw, rc), kept(rw, ft), kept(rw, fc)};
}

STAIRWRIGHT_VECTOR_CLONES
void judge(const SingleLeg front, const SingleLeg rear, const Distances kept, const Point wheel, const float* __restrict x,
           const float* __restrict z, const float* __restrict cos, const float* __restrict sin, const int count,
           std::uint8_t* __restrict clear) {
    const Point origin{0.0F, 0.0F};
    for (int k = 0; k < count; ++k) {
        const Point h{x[k] + cos[k] * front.hip.x + sin[k] * front.hip.z, z[k] - sin[k] * front.hip.x + cos[k] * front.hip.z};
        const Point g{x[k] + cos[k] * rear.hip.x + sin[k] * rear.hip.z, z[k] - sin[k] * rear.hip.x + cos[k] * rear.hip.z};
        const Point i = knee_point(front.thigh, front.calf, front.knee, h, origin);
        const Point j = knee_point(rear.thigh, rear.calf, rear.knee, g, wheel);
        float slack = segments(h, i, g, j, front.inverse_thigh, rear.inverse_thigh) - kept.thighs;
        slack = least(slack, segments(h, i, j, wheel, front.inverse_thigh, rear.inverse_calf) - kept.thigh_calf);
        slack = least(slack, segments(i, origin, g, j, front.inverse_calf, rear.inverse_thigh) - kept.calf_thigh);
        slack = least(slack, segments(i, origin, j, wheel, front.inverse_calf, rear.inverse_calf) - kept.calves);
        slack = least(slack, to_segment(wheel, h, i - h, front.inverse_thigh) - kept.rear_wheel_thigh);
        slack = least(slack, to_segment(wheel, i, origin - i, front.inverse_calf) - kept.rear_wheel_calf);
        slack = least(slack, to_segment(origin, g, j - g, rear.inverse_thigh) - kept.front_wheel_thigh);
        slack = least(slack, to_segment(origin, j, wheel - j, rear.inverse_calf) - kept.front_wheel_calf);
        clear[k] = slack >= 0.0F;
    }
}

}  // namespace

void legs_clear(const RobotModel& robot, double distance, Vec2 rear_wheel, const TrunkPoses& poses, std::uint8_t* clear) {
    const Leg &front = robot.legs[kFront].leg, &rear = robot.legs[kRear].leg;
    const Point wheel{static_cast<float>(rear_wheel.x), static_cast<float>(rear_wheel.z)};
    judge(SingleLeg(front), SingleLeg(rear), distances(front, rear, distance), wheel, poses.x, poses.z, poses.cos,
          poses.sin, poses.count, clear);
}

}  // namespace stairwright::lattice
