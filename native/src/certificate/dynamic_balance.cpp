#include "stairwright/certificate/dynamic_balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace stairwright::certificate {

namespace {

constexpr std::size_t kForces = 3 + 2 * kMotors;            // rows: components of the wrench, motors each way,
constexpr std::size_t kRows = kForces + 1;                  // and the sum of all forces
constexpr std::size_t kShare = kConeEdges;                  // variables: forces along edges, the share,
constexpr std::size_t kMissedBack = kShare + 1;             // what is missed the other way, and basic at first
constexpr std::size_t kColumns = kMissedBack + 3;           // what is missed and the slacks of the motors
constexpr double kTolerance = 1e-10;                        // of a reduced cost or a pivot that counts as zero
constexpr int kMostPivots = 10'000;                         // Bland's rule ends by itself, but for rounding
constexpr double kUnknown = 1e6;                            // more than any motor can give or any wrench is missed by

// A linear program with basic variables as functions of the others, which are zero: basic = value + rate * other.
// No variable is negative.
class Dictionary {
  public:
    explicit Dictionary(const Motion& motion) {
        std::iota(others_.begin(), others_.end(), std::size_t{0});
        std::iota(basics_.begin(), basics_.end(), kColumns);
        for (std::size_t i = 0; i < 3; ++i) {
            const double sign = motion.load[i] < 0.0 ? -1.0 : 1.0;
            value_[i] = sign * motion.load[i];
            for (std::size_t j = 0; j < kConeEdges; ++j) rate_[i][j] = -sign * motion.edges[j].wrench[i];
            rate_[i][kMissedBack + i] = 1.0;
            for (std::size_t j = 0; j < kColumns; ++j) cost_[j] += kMissed * rate_[i][j];
            cost_[kMissedBack + i] += kMissed;
        }
        cost_[kShare] = 1.0;
        for (std::size_t m = 0; m < kMotors; ++m)
            for (const bool up : {true, false}) {
                const std::size_t i = 3 + 2 * m + (up ? 0 : 1);
                const double limit = up ? motion.highest[m] : motion.lowest[m];
                value_[i] = -motion.torques[m] / limit;
                for (std::size_t j = 0; j < kConeEdges; ++j) rate_[i][j] = -motion.edges[j].torques[m] / limit;
                rate_[i][kShare] = 1.0;
            }
        value_[kForces] = kMostForce;
        for (std::size_t j = 0; j < kConeEdges; ++j) rate_[kForces][j] = -1.0;
    }

    DynamicBalance solve() {
        // A share that is large enough for all motors makes the first basis feasible.
        const auto hardest = std::min_element(value_.begin(), value_.end());
        if (*hardest < 0.0) pivot(static_cast<std::size_t>(hardest - value_.begin()), kShare);
        for (int k = 0; k < kMostPivots; ++k) {
            const std::size_t column = entering();
            if (column == kColumns) return {value_of(kShare), missed()};
            const std::size_t row = leaving(column);
            if (row == kRows) break;
            pivot(row, column);
        }
        return {kUnknown, kUnknown};
    }

  private:
    // By Bland's rule, which never cycles, the first variable that lowers the cost; `kColumns` at the optimum.
    std::size_t entering() const {
        std::size_t best = kColumns;
        for (std::size_t j = 0; j < kColumns; ++j)
            if (cost_[j] < -kTolerance && (best == kColumns || others_[j] < others_[best])) best = j;
        return best;
    }

    // The basic variable that first falls to zero, of several the first; `kRows` if none does.
    std::size_t leaving(std::size_t column) const {
        std::size_t best = kRows;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < kRows; ++i) {
            if (rate_[i][column] > -kTolerance) continue;
            const double step = std::max(value_[i], 0.0) / -rate_[i][column];
            if (step < least || (step == least && basics_[i] < basics_[best])) best = i, least = step;
        }
        return best;
    }

    void pivot(std::size_t row, std::size_t column) {
        const double by = 1.0 / rate_[row][column];
        for (double& rate : rate_[row]) rate *= -by;
        rate_[row][column] = by;
        value_[row] *= -by;
        for (std::size_t i = 0; i < kRows; ++i)
            if (i != row) {
                value_[i] += rate_[i][column] * value_[row];
                substitute(rate_[i], row, column);
            }
        substitute(cost_, row, column);
        std::swap(basics_[row], others_[column]);
    }

    void substitute(std::array<double, kColumns>& rates, std::size_t row, std::size_t column) const {
        const double factor = rates[column];
        if (factor == 0.0) return;
        rates[column] = 0.0;
        for (std::size_t j = 0; j < kColumns; ++j) rates[j] += factor * rate_[row][j];
    }

    double value_of(std::size_t variable) const {
        const auto found = std::find(basics_.begin(), basics_.end(), variable);
        return found == basics_.end() ? 0.0 : value_[static_cast<std::size_t>(found - basics_.begin())];
    }

    double missed() const {
        double most = 0.0;
        for (std::size_t i = 0; i < 3; ++i) most = std::max({most, value_of(kMissedBack + i), value_of(kColumns + i)});
        return most;
    }

    std::array<std::size_t, kColumns> others_{};
    std::array<std::size_t, kRows> basics_{};
    std::array<double, kRows> value_{};
    std::array<std::array<double, kColumns>, kRows> rate_{};
    std::array<double, kColumns> cost_{};
};

}  // namespace

DynamicBalance least_share(const Motion& motion) { return Dictionary(motion).solve(); }

}  // namespace stairwright::certificate
