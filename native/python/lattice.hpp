// What the bindings of the lattice share.
#pragma once

#include <memory>
#include <vector>

#include "arrays.hpp"
#include "stairwright/lattice/problem.hpp"

namespace stairwright::python {

using KeptArrays = std::vector<std::shared_ptr<const void>>;

struct KeptLegTable {
    lattice::LegTable table;
    KeptArrays arrays;  // that it views
};

struct KeptTrunkTable {
    lattice::TrunkTable table;
    KeptArrays arrays;
};

struct KeptProblem {
    lattice::Problem problem;
    KeptArrays arrays;
};

struct CellList {
    std::vector<lattice::Cell> cells;
};

}  // namespace stairwright::python
