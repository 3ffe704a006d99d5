// Problems on the body lattice: what the sweeps read. Tables stay where Python made them.
#include "lattice.hpp"

#include <cmath>
#include <memory>

#include "bindings.hpp"

namespace stairwright::python {

namespace {

using namespace lattice;

void require(bool fine, const char* message) {
    if (!fine) throw nb::value_error(message);
}

template <typename Array>
std::shared_ptr<const void> kept(const Array& array) {
    return std::make_shared<Array>(array);
}

using Table = In<std::int32_t, nb::ndim<2>>;

KeptLegTable leg_table(const In<float, nb::ndim<4>>& cost, const In<Bits, nb::ndim<3>>& possible,
                       const In<float, nb::ndim<4>>& moment, const In<float, nb::ndim<1>>& carried, const Table& x0,
                       const Table& z0, const Table& u, const Table& v) {
    const std::size_t n = cost.shape(0), pitches = cost.shape(1), rows = cost.shape(2);
    require(possible.shape(0) == n && possible.shape(1) == pitches && possible.shape(2) == rows, "possible: a bitset for each row of cost");
    require(moment.shape(0) == 2 && moment.shape(1) == 2 && moment.shape(2) == rows && moment.shape(3) == rows,
            "moment: (2, 2, rows, rows)");
    require(carried.shape(0) == n, "carried: one for each sample");
    for (const Table* one : {&x0, &z0, &u, &v})
        require(one->shape(0) == n && one->shape(1) == pitches, "x0, z0, u, v: one for each sample and pitch");
    KeptLegTable out;
    out.table = {static_cast<int>(n), static_cast<int>(pitches), static_cast<int>(rows), static_cast<int>(cost.shape(3)),
                 cost.data(), possible.data(), moment.data(), carried.data(), x0.data(), z0.data(), u.data(), v.data()};
    out.arrays = {kept(cost), kept(possible), kept(moment), kept(carried), kept(x0), kept(z0), kept(u), kept(v)};
    return out;
}

KeptTrunkTable trunk_table(const In<float, nb::ndim<3>>& cost, const In<Bits, nb::ndim<3>>& possible, int x0, int z0) {
    require(possible.shape(0) == cost.shape(0) && possible.shape(1) == cost.shape(1) && possible.shape(2) <= cost.shape(2),
            "possible: a bitset for each column of cost, without those that fill its rows");
    KeptTrunkTable out;
    out.table = {static_cast<int>(cost.shape(0)), static_cast<int>(cost.shape(1)), static_cast<int>(possible.shape(2)),
                 static_cast<int>(cost.shape(2)), x0, z0, cost.data(), possible.data()};
    out.arrays = {kept(cost), kept(possible)};
    return out;
}

KeptProblem make_problem(const RobotModel& robot, const Lattice& lattice, const Vector& s, const Points& centres,
                         const KeptLegTable& front, const KeptLegTable& rear, const KeptTrunkTable& trunk,
                         double least_leg_distance, double least_com_margin) {
    require(s.shape(0) == centres.shape(0), "centres: one for each of s");
    for (const KeptLegTable* leg : {&front, &rear})
        require(leg->table.samples == static_cast<int>(s.shape(0)) && leg->table.pitches == lattice.pitches,
                "leg tables: of these samples and pitches");
    require(trunk.table.pitches == lattice.pitches && trunk.table.stored >= trunk.table.columns + lattice.nx,
            "trunk table: of these pitches, with a window's room beyond its last column");
    KeptProblem out{{robot, lattice, {s.data(), s.data() + s.size()}, points(centres), {front.table, rear.table},
                     trunk.table, {}, {}, least_leg_distance, least_com_margin},
                    {}};
    for (int t = 0; t < lattice.pitches; ++t) {
        const double pitch = (t - lattice.pitches / 2) * lattice.turn;
        out.problem.cosines.push_back(std::cos(pitch));
        out.problem.sines.push_back(std::sin(pitch));
    }
    for (const auto* arrays : {&front.arrays, &rear.arrays, &trunk.arrays})
        out.arrays.insert(out.arrays.end(), arrays->begin(), arrays->end());
    return out;
}

using Column = In<std::int32_t, nb::ndim<1>>;

CellList make_cells(const KeptProblem& kept, const Column& front, const Column& rear, const Column& t0, const Column& z0,
                    const Column& x0, const Vector& slope, const In<std::int32_t, nb::shape<-1, 8>>& origin) {
    const Problem& problem = kept.problem;
    const std::size_t n = front.shape(0);
    const int samples = static_cast<int>(problem.s.size());
    require(rear.shape(0) == n && t0.shape(0) == n && z0.shape(0) == n && x0.shape(0) == n && slope.shape(0) == n && origin.shape(0) == n,
            "cells: columns of one length");
    CellList out;
    out.cells.resize(n);
    for (std::size_t c = 0; c < n; ++c) {
        Cell& cell = out.cells[c];
        cell = {front(c), rear(c), t0(c), z0(c), x0(c), slope(c), {}};
        require(cell.front >= 0 && cell.front < samples && cell.rear >= 0 && cell.rear < samples, "cells: front and rear are samples");
        require(cell.t0 >= 0 && cell.t0 + problem.lattice.nt <= problem.lattice.pitches, "cells: t0 leaves the table's pitches");
        const int column = cell.x0 - problem.trunk.x0;
        require(column >= 0 && column < problem.trunk.columns, "cells: x0 leaves the trunk's table");
    }
    for (std::size_t c = 0; c < n; ++c)
        for (std::size_t m = 0; m < kMoves.size(); ++m) {
            const int p = origin(c, m);
            require(p >= -1 && p < static_cast<int>(n), "cells: origin is a cell, or -1");
            require(p < 0 || (out.cells[p].front == out.cells[c].front - kMoves[m].front && out.cells[p].rear == out.cells[c].rear - kMoves[m].rear),
                    "cells: origin is where its move comes from");
            out.cells[c].origin[m] = p;
        }
    return out;
}

}  // namespace

void bind_lattice(nb::module_& m) {
    m.attr("FORWARD_MOVES") = kForwardMoves;
    m.attr("WHEEL_MOVES") = static_cast<int>(kMoves.size());
    nb::class_<Lattice>(m, "Lattice")
        .def("__init__", [](Lattice* self, double step, double turn, int pitches, int nt, int nz, int nx, int row) {
            require(step > 0.0 && turn > 0.0 && nt > 0 && nz > 0 && nx > 0 && pitches >= nt, "lattice: sizes above 0, no more pitches in a window than in all");
            require(row >= nx + 4 && row <= kWord && nt < 1000 && nz < 1000, "lattice: row holds the window with its rim, in at most 64 columns");
            new (self) Lattice{step, turn, pitches, nt, nz, nx, row};
        }, nb::arg("step"), nb::arg("turn"), nb::arg("pitches"), nb::arg("nt"), nb::arg("nz"), nb::arg("nx"), nb::arg("row"));
    nb::class_<KeptLegTable>(m, "LatticeLegTable");
    nb::class_<KeptTrunkTable>(m, "LatticeTrunkTable");
    m.def("lattice_leg_table", &leg_table, nb::arg("cost").noconvert(), nb::arg("possible").noconvert(), nb::arg("moment").noconvert(),
          nb::arg("carried").noconvert(), nb::arg("x0").noconvert(), nb::arg("z0").noconvert(), nb::arg("u").noconvert(), nb::arg("v").noconvert());
    m.def("lattice_trunk_table", &trunk_table, nb::arg("cost").noconvert(), nb::arg("possible").noconvert(), nb::arg("x0"), nb::arg("z0"));
    nb::class_<KeptProblem>(m, "LatticeProblem")
        .def("cells", &make_cells, nb::arg("front"), nb::arg("rear"), nb::arg("t0"), nb::arg("z0"), nb::arg("x0"),
             nb::arg("slope"), nb::arg("origin"));
    m.def("lattice_problem", &make_problem, nb::arg("robot"), nb::arg("lattice"), nb::arg("s"), nb::arg("centres"),
          nb::arg("front"), nb::arg("rear"), nb::arg("trunk"), nb::arg("least_leg_distance"), nb::arg("least_com_margin"));
    nb::class_<CellList>(m, "LatticeCells").def("__len__", [](const CellList& list) { return list.cells.size(); });
}

}  // namespace stairwright::python
