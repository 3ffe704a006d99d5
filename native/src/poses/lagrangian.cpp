#include "stairwright/poses/lagrangian.hpp"

namespace stairwright::poses {

namespace {

// Curvature of "the wheel is on the curve" with the multiplier that its leg's angles imply.
void add_wheel_curvature(const PoseModel& model, const PoseState& st, int leg, const GradientU& gu, HessianU& hessian) {
    const PosePoint& wheel = st.points[model.wheel[leg]];
    const int upper = 1 + 2 * leg;
    const Vec2 a = {wheel.arms[upper].z, -wheel.arms[upper].x}, b = {wheel.arms[upper + 1].z, -wheel.arms[upper + 1].x};
    const double det = cross(a, b), g1 = gu[2 + upper], g2 = gu[3 + upper];
    const Vec2 multiplier = {(g1 * b.z - g2 * a.z) / det, (a.x * g2 - b.x * g1) / det};
    for (const int angle : {0, upper, upper + 1}) hessian[2 + angle][2 + angle] += dot(multiplier, wheel.arms[angle]);
    hessian[7 + leg][7 + leg] -= st.curvature[leg] * (multiplier.z * st.tangent[leg].x - multiplier.x * st.tangent[leg].z);
}

}  // namespace

GradientY reduce(const PoseState& st, const GradientU& gu) {
    GradientY out;
    for (int k = 0; k < kUnknowns; ++k) {
        out[k] = gu[k < 3 ? k : 4 + k];
        for (int a = 0; a < 4; ++a) out[k] += gu[3 + a] * st.link_turns[a][k];
    }
    return out;
}

void lagrangian(const PoseModel& model, const PoseTask& task, const PoseState& st, const ActiveRows& active, GradientY& g,
                HessianY& h) {
    GradientU gu{};
    HessianU hu{};
    for (int k = 0; k < 7; ++k) {
        const double w = 2.0 * task.weights[k];
        const double error = (k < 3 ? st.y[k] : st.q[k - 3]) - task.reference[k];
        gu[k] += w * error;
        hu[k][k] += w;
        if (k < 3) continue;
        // Joint = angle of its link minus angle of the link that it turns against.
        const int j = k == 3 || k == 5 ? 2 : k - 1;
        gu[j] -= w * error;
        hu[j][j] += w;
        hu[k][j] -= w;
        hu[j][k] -= w;
    }
    g = reduce(st, gu);
    for (std::size_t k = 0; k < active.rows.size(); ++k) {
        const GradientU row = gradient(st, active.rows[k]);
        for (int i = 0; i < kU; ++i) gu[i] -= active.multipliers[k] * row[i];
        add_curvature(st, active.rows[k], -active.multipliers[k], hu);
    }
    for (int leg = 0; leg < 2; ++leg) add_wheel_curvature(model, st, leg, gu, hu);
    // H = Z' Hu Z, where Z holds the turns of the link angles and ones elsewhere.
    std::array<GradientY, kU> half;
    for (int i = 0; i < kU; ++i) half[i] = reduce(st, hu[i]);
    for (int k = 0; k < kUnknowns; ++k) {
        for (int j = 0; j < kUnknowns; ++j) {
            h[k][j] = half[k < 3 ? k : 4 + k][j];
            for (int a = 0; a < 4; ++a) h[k][j] += st.link_turns[a][k] * half[3 + a][j];
        }
    }
}

}  // namespace stairwright::poses
