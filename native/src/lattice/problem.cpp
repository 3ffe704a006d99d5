#include "stairwright/lattice/problem.hpp"

#include <algorithm>

namespace stairwright::lattice {

TableWindow table_window(const Problem& problem, const Cell& cell, int t) {
    const LegTable &front = problem.legs[kFront], &rear = problem.legs[kRear];
    const TrunkTable& trunk = problem.trunk;
    const int pitch = cell.t0 + t;
    const std::size_t f = front.at(cell.front, pitch), r = rear.at(cell.rear, pitch);
    TableWindow out;
    out.front_row = cell.z0 - front.z0[f];
    out.rear_row = cell.z0 - rear.z0[r];
    out.trunk_row = cell.z0 - trunk.z0;
    out.front_column = cell.x0 - front.x0[f];
    out.rear_column = cell.x0 - rear.x0[r];
    out.trunk_column = cell.x0 - trunk.x0;
    out.low = std::max({0, -out.front_row, -out.rear_row, -out.trunk_row});
    out.high = std::min({problem.lattice.nz, front.rows - out.front_row, rear.rows - out.rear_row, trunk.rows - out.trunk_row});
    return out;
}

ComTerms::ComTerms(const Problem& problem, const Cell& cell)
    : per_mass(static_cast<float>(1.0 / problem.robot.mass)),
      trunk_share(static_cast<float>(problem.robot.robot.trunk.mass / problem.robot.mass)),
      carried(per_mass * (problem.legs[kFront].carried[cell.front] + problem.legs[kRear].carried[cell.rear])) {}

float ComTerms::trunk_offset(const Problem& problem, double cos, double sin) const {
    const Vec2 com = problem.robot.robot.trunk.com;
    return trunk_share * static_cast<float>(cos * com.x + sin * com.z);
}

}  // namespace stairwright::lattice
