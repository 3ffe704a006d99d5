// The two passes of the search: widest paths, and the cheapest among those that are wide enough.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>

#include <tuple>

#include "bindings.hpp"
#include "lattice.hpp"
#include "stairwright/lattice/cheapest_paths.hpp"
#include "stairwright/lattice/leg_clearance.hpp"

namespace stairwright::python {

namespace {

using namespace lattice;

void require(bool fine, const char* message) {
    if (!fine) throw nb::value_error(message);
}

// Rows: CoM intervals at the friction, at the reserve, with lag.
using Intervals = In<double, nb::shape<-1, 6>>;
using Marks = In<bool, nb::ndim<1>>;
using Range = In<std::int32_t, nb::shape<3, 2>>;
using Index = std::tuple<int, int, int>;

std::vector<ComIntervals> intervals(const Intervals& rows, std::size_t n) {
    require(rows.shape(0) == n, "com: one row for each cell");
    std::vector<ComIntervals> out(n);
    for (std::size_t c = 0; c < n; ++c)
        out[c] = {{rows(c, 0), rows(c, 1)}, {rows(c, 2), rows(c, 3)}, {rows(c, 4), rows(c, 5)}};
    return out;
}

std::vector<std::uint8_t> marks(const Marks& given, std::size_t n) {
    require(given.shape(0) == n, "marks: one for each cell");
    return {given.data(), given.data() + n};
}

WindowRange window_range(const Range& r, const Lattice& lattice) {
    const std::array<int, 3> sizes = {lattice.nt, lattice.nz, lattice.nx};
    for (std::size_t k = 0; k < 3; ++k) require(0 <= r(k, 0) && r(k, 0) <= r(k, 1) && r(k, 1) <= sizes[k], "range: within the window");
    return {{r(0, 0), r(1, 0), r(2, 0)}, {r(0, 1), r(1, 1), r(2, 1)}};
}

WindowPose window_pose(const Index& at, const Lattice& lattice) {
    const auto [t, z, x] = at;
    require(0 <= t && t < lattice.nt && 0 <= z && z < lattice.nz && 0 <= x && x < lattice.nx, "pose: within the window");
    return {t, z, x};
}

int checked_moves(int moves) {
    require(0 < moves && moves <= static_cast<int>(kMoves.size()), "moves: 1 to 8");
    return moves;
}

std::size_t checked_cell(std::size_t c, std::size_t n) {
    require(c < n, "cell: no such one");
    return c;
}

int checked_level(int level) {
    require(0 < level && level < 256, "level: 1 to 255");
    return level;
}

template <typename T>
using View = nb::ndarray<nb::numpy, const T, nb::ndim<1>>;

template <typename T>
View<T> column(const std::vector<T>& values) {
    return {values.data(), {values.size()}};
}

struct WidestSearch {
    const Problem& problem;
    const std::vector<Cell>& cells;
    std::vector<ComIntervals> com;
    WidestPaths paths;

    WidestSearch(const KeptProblem& kept, const CellList& list, const Intervals& rows)
        : problem(kept.problem), cells(list.cells), com(intervals(rows, cells.size())), paths(problem.lattice, cells.size()) {}

    bool sweep(const Marks& entry, const Range& begin, int moves) {
        const std::vector<std::uint8_t> entries = marks(entry, cells.size());
        const WindowRange range = window_range(begin, problem.lattice);
        checked_moves(moves);
        const nb::gil_scoped_release released;
        return paths.sweep(problem, cells, com, entries, range, moves);
    }
};

struct CheapestSearch {
    const Problem& problem;
    const std::vector<Cell>& cells;
    const WidestPaths& widest;
    std::vector<ComIntervals> com;
    CheapestPaths paths;

    CheapestSearch(const WidestSearch& search, const Intervals& rows, const Marks& wanted, int level, const CostWeights& weights, int moves)
        : problem(search.problem), cells(search.cells), widest(search.paths), com(intervals(rows, cells.size())),
          paths(widest, checked_level(level), marks(wanted, cells.size()), weights, checked_moves(moves)) {}

    bool sweep(std::size_t source, const Index& begin) {
        checked_cell(source, cells.size());
        const WindowPose pose = window_pose(begin, problem.lattice);
        const nb::gil_scoped_release released;
        return paths.sweep(problem, cells, com, widest, source, pose);
    }

    using Rows = nb::ndarray<nb::numpy, std::int32_t>;
    std::optional<Rows> backtrack(std::size_t source, std::size_t goal, const Index& at, std::size_t longest) const {
        checked_cell(source, cells.size());
        const auto found = paths.backtrack(problem, cells, source, checked_cell(goal, cells.size()), window_pose(at, problem.lattice), longest);
        if (!found) return std::nullopt;
        std::vector<std::int32_t> rows;
        rows.reserve(5 * found->size());
        for (auto p = found->rbegin(); p != found->rend(); ++p) rows.insert(rows.end(), {p->front, p->rear, p->pitch, p->z, p->x});
        return give(std::move(rows), {found->size(), 5});
    }
};

View<std::uint8_t> width(const WidestSearch& search, std::size_t c) {
    require(checked_cell(c, search.cells.size()) < search.paths.size() && search.paths.slot[c] >= 0, "cell: never entered");
    return {search.paths.width(c), {search.paths.volume()}};
}

void bind_widest(nb::module_& m) {
    nb::class_<WidestSearch>(m, "WidestPaths")
        .def(nb::init<const KeptProblem&, const CellList&, const Intervals&>(), nb::arg("problem"), nb::arg("cells"), nb::arg("com"),
             nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>())
        .def("sweep", &WidestSearch::sweep, nb::arg("entry"), nb::arg("begin"), nb::arg("moves"),
             "One sweep over all cells; whether any changed.")
        .def("limit_torques", [](WidestSearch& s, const WheelPath& path, double friction, double lag, double share) {
            require(friction > 0.0 && share > 0.0, "friction, share: above 0");
            s.paths.limit_torques(TorqueLimits(path, friction, lag, share, s.cells.size()));
        }, nb::arg("path"), nb::arg("friction"), nb::arg("lag"), nb::arg("share"), "Only poses that motors hold with that share of their torque.")
        .def("look_everywhere", [](WidestSearch& s) { std::fill(s.paths.history.seen.begin(), s.paths.history.seen.end(), -1); },
             "Make the next sweep look at every cell.")
        .def("leading_to", [](const WidestSearch& s, int level, std::size_t goal, int moves) {
            auto found = s.paths.leading_to(s.cells, checked_level(level), checked_cell(goal, s.cells.size()), checked_moves(moves));
            auto owned = std::make_unique<std::vector<std::uint8_t>>(std::move(found));
            auto* data = reinterpret_cast<bool*>(owned->data());
            const std::size_t n = owned->size();
            nb::capsule owner(owned.release(), [](void* p) noexcept { delete static_cast<std::vector<std::uint8_t>*>(p); });
            return nb::ndarray<nb::numpy, bool, nb::ndim<1>>(data, {n}, owner);
        }, nb::arg("level"), nb::arg("goal"), nb::arg("moves"), "Cells that lead to `goal` through poses at least `level` wide.")
        .def("width", &width, nb::arg("cell"), nb::rv_policy::reference_internal, "Widths of a cell that was entered, with the rim.")
        .def_prop_ro("best", [](const WidestSearch& s) { return column(s.paths.best); }, nb::rv_policy::reference_internal)
        .def_prop_ro("visits", [](const WidestSearch& s) { return s.paths.history.visits; });
}

void bind_cheapest(nb::module_& m) {
    nb::class_<CostWeights>(m, "LatticeWeights")
        .def("__init__", [](CostWeights* self, double com_margin, double pitch, double height, double wanted_margin, double body_step) {
            require(height > 0.0 && wanted_margin > 0.0, "height, wanted_margin: above 0");
            new (self) CostWeights{com_margin, pitch, height, wanted_margin, body_step};
        }, nb::arg("com_margin"), nb::arg("pitch"), nb::arg("height"), nb::arg("wanted_margin"), nb::arg("body_step"));
    nb::class_<CheapestSearch>(m, "CheapestPaths")
        .def(nb::init<const WidestSearch&, const Intervals&, const Marks&, int, const CostWeights&, int>(), nb::arg("widest"), nb::arg("com"),
             nb::arg("wanted"), nb::arg("level"), nb::arg("weights"), nb::arg("moves"), nb::keep_alive<1, 2>())
        .def("sweep", &CheapestSearch::sweep, nb::arg("source"), nb::arg("begin"), "One sweep over all cells; whether any changed.")
        .def("look_everywhere", [](CheapestSearch& s) { std::fill(s.paths.history.seen.begin(), s.paths.history.seen.end(), -1); },
             "Make the next sweep look at every cell.")
        .def("cheapest_pose", [](const CheapestSearch& s, std::size_t cell, const Range& range) {
            const WindowPose p = s.paths.cheapest_pose(s.problem.lattice, checked_cell(cell, s.cells.size()), window_range(range, s.problem.lattice));
            return Index{p.t, p.z, p.x};
        }, nb::arg("cell"), nb::arg("range"))
        .def("backtrack", &CheapestSearch::backtrack, nb::arg("source"), nb::arg("goal"), nb::arg("pose"), nb::arg("longest"),
             "Rows (front and rear sample, pitch, z, x) from `source` to `goal`, if the path ends within `longest`.")
        .def_prop_ro("visits", [](const CheapestSearch& s) { return s.paths.history.visits; });
}

// Which of the poses (n, 4) x, z from the front wheel, cos and sin of the pitch keep the legs clear of each other.
nb::ndarray<nb::numpy, std::uint8_t> clear(const RobotModel& robot, double distance, std::pair<double, double> rear_wheel,
                                           const In<float, nb::shape<4, -1>>& poses) {
    const std::size_t n = poses.shape(1);
    const float* p = poses.data();
    std::vector<std::uint8_t> out(n);
    legs_clear(robot, distance, {rear_wheel.first, rear_wheel.second}, {p, p + n, p + 2 * n, p + 3 * n, static_cast<int>(n)}, out.data());
    return give(std::move(out));
}

}  // namespace

void bind_lattice_sweeps(nb::module_& m) {
    bind_widest(m);
    bind_cheapest(m);
    m.def("legs_clear", [](const RobotModel& robot, double distance, double x, double z, const In<float, nb::shape<4, -1>>& poses) {
        return clear(robot, distance, {x, z}, poses);
    }, nb::arg("robot"), nb::arg("distance"), nb::arg("rear_x"), nb::arg("rear_z"), nb::arg("poses"));
}

}  // namespace stairwright::python
