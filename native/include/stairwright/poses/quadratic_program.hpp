// Small dense quadratic programmes: the dual active-set method of Goldfarb and Idnani (1983).
#pragma once

#include <array>
#include <span>
#include <vector>

namespace stairwright::poses {

inline constexpr int kMostVariables = 6;
using QpVector = std::array<double, kMostVariables>;
using QpMatrix = std::array<QpVector, kMostVariables>;

enum class QpStatus { kSolved, kInfeasible, kStalled };

// minimise x'Hx/2 + g'x subject to A x >= b, for n <= kMostVariables unknowns.
struct QuadraticProgram {
    int n = 0;
    QpMatrix hessian{};  // positive definite
    QpVector gradient{};
    std::vector<QpVector> rows;
    std::vector<double> bounds;

    // Fills the minimiser and the multipliers (>= 0, one a row).
    QpStatus solve(QpVector& x, std::vector<double>& multipliers) const;
};

// Lower Cholesky factor of H less `least` on the diagonal; false if not all eigenvalues of H are above `least`.
bool cholesky(const QpMatrix& h, int n, double least, QpMatrix& factor);

// Make H positive definite: negative eigenvalues change sign, and none stays below `least`.
void make_positive(QpMatrix& h, int n, double least);

}  // namespace stairwright::poses
