// The balance QP (eqs 11-12): forces of four wheels, each tangential and normal, in friction cones.
#pragma once

#include <array>

namespace stairwright::control {

using Matrix8 = std::array<std::array<double, 8>, 8>;
using Forces = std::array<double, 8>;  // per wheel FL, FR, RL, RR: tangential, normal [N]

// min F' H F / 2 + g' F subject to |t| <= friction n and 0 <= n <= load_limit for each wheel.
struct BalanceQp {
    Matrix8 H{};  // positive definite
    std::array<double, 8> g{};
    std::array<double, 4> friction{};
    double load_limit = 0.0;  // N
};

// Replaces `forces`, which holds a guess, by the minimiser. A guess of the active rows, started at those of the
// last solution, is solved exactly and checked (nearly always right); else an interior point finds the rows.
// Returns the iterations of the interior point, 0 where none was needed.
int solve(const BalanceQp& qp, Forces& forces);

// Mehrotra's predictor-corrector from a feasible start (no traction, a quarter of the load limit).
int interior_point(const BalanceQp& qp, Forces& forces);

// Replaces the lower triangle of the leading n rows of K by its Cholesky factor.
void factor(Matrix8& K, int n);
// Solves K K' x = b in place for a factor K.
void solve_factored(const Matrix8& K, std::array<double, 8>& b, int n);

}  // namespace stairwright::control
