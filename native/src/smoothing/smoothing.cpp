#include "stairwright/smoothing/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "early_faces.hpp"
#include "residuals.hpp"

namespace stairwright::smoothing {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLinear = 1e-4;     // m and rad; a node that has moved by less is extrapolated
constexpr double kFixed = 1e12;      // stiffness that no node moves against
constexpr double kGain = 0.01;       // cost of a quarter of a millimetre too little: a smaller gain ends the smoothing
constexpr double kLongestStep = 0.05;  // m and rad
constexpr double kNewCost = 1.0 - 1e-12;

// A node as it was when it was last looked at.
struct Linearisation {
    Body body{kInfinity, kInfinity, kInfinity};
    Residuals residuals{};
    NodeJacobian jacobian{};
    std::array<std::array<double, 3>, 3> hessian{};  // J J', columns counted from the diagonal
};

void set_hessian(Linearisation& node) {
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) {
            double total = 0.0;
            for (int m = 0; m < kResiduals; ++m) total += node.jacobian[a][m] * node.jacobian[b][m];
            node.hessian[a][b - a] = total;
        }
    }
}

bool has_moved(const Body& a, const Body& b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.z - b.z), std::abs(a.pitch - b.pitch)}) > kLinear;
}

double limited(double step) { return std::min(kLongestStep, std::max(-kLongestStep, step)); }

// One run of Levenberg-Marquardt.
class Smoother {
  public:
    Smoother(const SmoothingProblem& problem, std::span<Body> nodes)
        : problem_(problem), nodes_(nodes), radii_(query_radii(problem.objective)),
          evenness_(problem.objective.evenness.hessian(nodes.size())), geometry_(nodes.size()),
          residuals_(nodes.size()), fresh_(nodes.size()), seen_(nodes.size()), best_(nodes.begin(), nodes.end()),
          hessian_(evenness_), uneven_(3 * nodes.size()), gradient_(3 * nodes.size()) {}

    double run(int iterations) {
        for (int k = 0; k < iterations; ++k) {
            const double cost = evaluate();
            if (cost < least_ * kNewCost) {
                // One bad place counts little in a long course: ask for more where there are more nodes.
                const double n = static_cast<double>(nodes_.size());
                const bool settled = least_ - cost < std::max(kGain, 2e-3 * std::min(1.0, 20.0 / n) * least_);
                least_ = cost;
                std::copy(nodes_.begin(), nodes_.end(), best_.begin());
                damping_ = std::max(damping_ * 0.4, 1e-6);
                if (settled) break;
                linearise();
            } else {
                damping_ *= 6.0;
            }
            if (damping_ > 1e4) break;
            step();
        }
        std::copy(best_.begin(), best_.end(), nodes_.begin());
        return least_;
    }

  private:
    // Cost of the nodes as they are; once it exceeds the least so far, no more than that is known.
    double evaluate() {
        double cost = problem_.objective.evenness.cost(nodes_, uneven_);
        for (std::size_t k = 0; k < nodes_.size() && cost < least_ * kNewCost; ++k) {
            fresh_[k] = has_moved(nodes_[k], seen_[k].body);
            if (fresh_[k]) {
                geometry_[k] = pose_geometry(problem_.terrain, problem_.robot, nodes_[k], problem_.wheels[k], radii_);
                residuals_[k] = residuals(problem_, k, nodes_[k], geometry_[k], early_clearance(problem_, k, nodes_[k], geometry_[k].posture));
            } else {
                residuals_[k] = extrapolate(seen_[k].residuals, seen_[k].jacobian, seen_[k].body, nodes_[k]);
            }
            for (const double r : residuals_[k]) cost += r * r;
        }
        return cost;
    }

    // Half the gradient and the Gauss-Newton matrix at the nodes as they are.
    void linearise() {
        hessian_ = evenness_;
        gradient_ = uneven_;
        for (std::size_t k = 0; k < nodes_.size(); ++k) {
            Linearisation& node = seen_[k];
            if (fresh_[k]) {
                if (!problem_.fixed[k]) {
                    node.jacobian = differentiate(problem_, k, nodes_[k], geometry_[k], residuals_[k]);
                    set_hessian(node);
                }
                node.body = nodes_[k];
                node.residuals = residuals_[k];
            }
            if (problem_.fixed[k])
                for (int a = 0; a < 3; ++a) hessian_[3 * k + a][0] += kFixed;
            for (int a = 0; a < 3; ++a) {
                for (int b = 0; b < 3 - a; ++b) hessian_[3 * k + a][b] += node.hessian[a][b];
                for (int m = 0; m < kResiduals; ++m) gradient_[3 * k + a] += node.jacobian[a][m] * residuals_[k][m];
            }
        }
    }

    void step() {
        BandMatrix h = hessian_;
        std::vector<double> delta = gradient_;
        delta.resize(gradient_.size() + kBand);
        for (std::size_t i = 0; i < gradient_.size(); ++i) h[i][0] += damping_ * (1.0 + h[i][0]);
        solve_banded(h, delta);
        for (std::size_t k = 0; k < nodes_.size(); ++k)
            nodes_[k] = {best_[k].x - limited(delta[3 * k]), best_[k].z - limited(delta[3 * k + 1]),
                         best_[k].pitch - limited(delta[3 * k + 2])};
    }

    const SmoothingProblem& problem_;
    std::span<Body> nodes_;
    QueryRadii radii_;
    BandMatrix evenness_;
    std::vector<PoseGeometry> geometry_;
    std::vector<Residuals> residuals_;
    std::vector<bool> fresh_;
    std::vector<Linearisation> seen_;
    std::vector<Body> best_;
    BandMatrix hessian_;
    std::vector<double> uneven_, gradient_;
    double damping_ = 1e-3, least_ = kInfinity;
};

}  // namespace

double smooth(const SmoothingProblem& problem, std::span<Body> nodes, int iterations) {
    return Smoother(problem, nodes).run(iterations);
}

}  // namespace stairwright::smoothing
