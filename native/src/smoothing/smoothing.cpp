#include "stairwright/smoothing/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "residuals.hpp"

namespace stairwright::smoothing {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLinear = 1e-4;     // m and rad; a node that has moved by less is extrapolated
constexpr double kFixed = 1e12;      // stiffness that no node moves against
constexpr double kGain = 0.01;       // cost of a quarter of a millimetre too little: a smaller gain ends the smoothing
constexpr double kLongestStep = 0.05;  // m and rad
constexpr double kFirstDamping = 1e-3, kMostDamping = 1e4;
constexpr double kWorse = 1.02;      // times what a node cost; a step that makes it dearer is too long there
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
    Smoother(const SmoothingProblem& problem, std::span<Body> nodes, bool each)
        : problem_(problem), each_(each), nodes_(nodes), radii_(query_radii(problem.objective)),
          evenness_(problem.objective.evenness.hessian(nodes.size())), geometry_(nodes.size()),
          residuals_(nodes.size()), fresh_(nodes.size()), seen_(nodes.size()), best_(nodes.begin(), nodes.end()),
          hessian_(evenness_), uneven_(3 * nodes.size()), gradient_(3 * nodes.size()), damping_(nodes.size(), kFirstDamping),
          costs_(nodes.size()), least_costs_(nodes.size(), kInfinity) {}

    double run(int iterations) {
        for (int k = 0; k < iterations; ++k) {
            const double cost = evaluate();
            if (cost < least_ * kNewCost) {
                // One bad place counts little in a long course: ask for more where there are more nodes.
                const double n = static_cast<double>(nodes_.size());
                const bool settled = least_ - cost < std::max(kGain, 2e-3 * std::min(1.0, 20.0 / n) * least_);
                least_ = cost;
                std::copy(nodes_.begin(), nodes_.end(), best_.begin());
                if (settled) break;
                adapt(true);
                linearise();
            } else {
                adapt(false);
            }
            if (std::ranges::all_of(damping_, [](double d) { return d > kMostDamping; })) break;
            step();
        }
        std::copy(best_.begin(), best_.end(), nodes_.begin());
        return least_;
    }

  private:
    // Less damping after a step that has helped, more after one that has not; with `each_` nodes by what they cost themselves.
    void adapt(bool helped) {
        const auto worse = [&](std::size_t k) { return costs_[k] > kWorse * least_costs_[k] + kGain * kGain; };
        bool told = false;
        for (std::size_t k = 0; each_ && k < damping_.size(); ++k) told = told || worse(k);
        for (std::size_t k = 0; k < damping_.size(); ++k) {
            if (told && worse(k)) damping_[k] *= helped ? 2.0 : 6.0;
            else if (helped) damping_[k] = std::max(damping_[k] * 0.4, 1e-6);
            else if (!told) damping_[k] *= 6.0;
        }
        if (helped) least_costs_ = costs_;
    }

    // Cost of the nodes as they are; once it exceeds the least so far, no more than that is known.
    double evaluate() {
        double cost = problem_.objective.evenness.cost(nodes_, uneven_);
        for (std::size_t k = 0; k < nodes_.size() && (each_ || cost < least_ * kNewCost); ++k) {
            fresh_[k] = has_moved(nodes_[k], seen_[k].body);
            if (fresh_[k]) {
                geometry_[k] = pose_geometry(problem_.terrain, problem_.robot, nodes_[k], problem_.wheels[k], radii_);
                residuals_[k] = residuals(problem_, k, nodes_[k], geometry_[k], surprise_clearances(problem_, k, nodes_[k], geometry_[k].posture));
            } else {
                residuals_[k] = extrapolate(seen_[k].residuals, seen_[k].jacobian, seen_[k].body, nodes_[k]);
            }
            costs_[k] = 0.0;
            for (const double r : residuals_[k]) costs_[k] += r * r;
            cost += costs_[k];
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
        for (std::size_t i = 0; i < gradient_.size(); ++i) h[i][0] += damping_[i / 3] * (1.0 + h[i][0]);
        solve_banded(h, delta);
        for (std::size_t k = 0; k < nodes_.size(); ++k)
            nodes_[k] = {best_[k].x - limited(delta[3 * k]), best_[k].z - limited(delta[3 * k + 1]),
                         best_[k].pitch - limited(delta[3 * k + 2])};
    }

    const SmoothingProblem& problem_;
    const bool each_;
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
    std::vector<double> damping_, costs_, least_costs_;  // by node
    double least_ = kInfinity;
};

}  // namespace

double smooth(const SmoothingProblem& problem, std::span<Body> nodes, int iterations, bool each) {
    return Smoother(problem, nodes, each).run(iterations);
}

}  // namespace stairwright::smoothing
