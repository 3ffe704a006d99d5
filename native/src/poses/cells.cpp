#include "stairwright/poses/cells.hpp"

#include <algorithm>
#include <cmath>

namespace stairwright::poses {

namespace {
constexpr double kSpike = 1e-5;  // m; ground needs some width
constexpr double kDepth = 1.0;  // m; of cells below their lowest corner
}  // namespace

std::vector<Cell> terrain_cells(const std::vector<Vec2>& p) {
    std::vector<Cell> out;
    std::size_t begin = 0;
    for (std::size_t i = 1; i < p.size(); ++i) {
        if (i + 1 < p.size() && cross(p[i] - p[i - 1], p[i + 1] - p[i]) <= 1e-12) continue;
        std::vector<Vec2> chain(p.begin() + static_cast<std::ptrdiff_t>(begin), p.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        double top = chain.front().z, low = top;
        for (const Vec2 v : chain) top = std::max(top, v.z), low = std::min(low, v.z);
        if (chain.back().x - chain.front().x < kSpike) {  // a spike, or a face between two concave corners
            const double x = chain.front().x;
            chain = {{x - kSpike, top}, {x + kSpike, top}};
            low = top;
        }
        Cell cell;
        for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
            const Vec2 d = chain[k + 1] - chain[k];
            const double length = norm(d);
            const Vec2 normal = {-d.z / length, d.x / length};
            cell.faces.push_back({normal, dot(normal, chain[k])});
        }
        cell.left = chain.front().x, cell.right = chain.back().x, cell.top = top;
        cell.faces.push_back({{-1.0, 0.0}, -cell.left});
        cell.faces.push_back({{1.0, 0.0}, cell.right});
        cell.corners = std::move(chain);
        cell.corners.push_back({cell.right, low - kDepth});
        cell.corners.push_back({cell.left, low - kDepth});
        out.push_back(std::move(cell));
        begin = i;
    }
    return out;
}

}  // namespace stairwright::poses
