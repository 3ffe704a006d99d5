// Tables and cells of the search as NumPy arrays.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/lattice/ground_clearance.hpp"
#include "stairwright/lattice/leg_tables.hpp"

namespace stairwright::python {

namespace {

using namespace lattice;

using Pairs = In<std::int32_t, nb::shape<-1, 2>>;
using Array = nb::ndarray<nb::numpy>;
using Arrays = nb::typed<nb::dict, nb::str, nb::any>;

template <typename T>
Array owned(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
    return Array(give(std::move(values), shape));
}

std::vector<SamplePair> sample_pairs_of(const Pairs& rows, std::size_t samples) {
    std::vector<SamplePair> out(rows.shape(0));
    const auto n = static_cast<std::int32_t>(samples);
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k] = {rows(k, 0), rows(k, 1)};
        if (rows(k, 0) < 0 || rows(k, 0) >= n || rows(k, 1) < 0 || rows(k, 1) >= n) throw nb::value_error("pairs: of the samples");
    }
    return out;
}

nb::ndarray<nb::numpy, std::int32_t> pairs_found(const Points& centres, double near, double far, int front, int rear) {
    std::vector<std::int32_t> out;
    for (const SamplePair pair : sample_pairs(points(centres), near, far, front, rear)) out.insert(out.end(), {pair.front, pair.rear});
    const std::size_t n = out.size() / 2;
    return give(std::move(out), {n, 2});
}

Arrays cells_found(const WheelPath& path, const Vector& s, const Points& centres, const Pairs& pairs, const WindowShape& shape,
                   double friction, double reserve, double least_com_margin) {
    if (s.size() != centres.shape(0)) throw nb::value_error("centres: one for each of s");
    const std::vector<double> at(s.data(), s.data() + s.size());
    const std::vector<Vec2> wheels = points(centres);
    const std::vector<SamplePair> given = sample_pairs_of(pairs, at.size());
    CellTable table;
    {
        const nb::gil_scoped_release released;
        table = cell_table({path, at, wheels, friction, reserve, least_com_margin}, given, shape);
    }
    const std::size_t n = table.cells.size();
    std::vector<std::int32_t> front, rear, t0, z0, x0, origin;
    std::vector<double> slope, spans;
    for (std::size_t c = 0; c < n; ++c) {
        const Cell& cell = table.cells[c];
        front.push_back(cell.front), rear.push_back(cell.rear);
        t0.push_back(cell.t0), z0.push_back(cell.z0), x0.push_back(cell.x0);
        slope.push_back(cell.slope);
        origin.insert(origin.end(), cell.origin.begin(), cell.origin.end());
        const auto& [friction_span, reserve_span, lag_span] = table.com[c];
        for (const auto& span : {friction_span, reserve_span, lag_span}) spans.insert(spans.end(), {span.lower, span.upper});
    }
    Arrays out;
    out["front"] = owned(std::move(front), {n});
    out["rear"] = owned(std::move(rear), {n});
    out["number"] = owned(std::move(table.number), {at.size(), at.size()});
    out["spans"] = owned(std::move(spans), {n, 6});
    out["t0"] = owned(std::move(t0), {n});
    out["z0"] = owned(std::move(z0), {n});
    out["x0"] = owned(std::move(x0), {n});
    out["slope"] = owned(std::move(slope), {n});
    out["origin"] = owned(std::move(origin), {n, kMoves.size()});
    return out;
}

void fill_lag_spans(const WheelPath& path, const Vector& s, const In<std::int32_t, nb::ndim<1>>& front,
                    const In<std::int32_t, nb::ndim<1>>& rear, const In<bool, nb::ndim<1>>& wanted,
                    const InOut<double, nb::shape<-1, 6>>& spans, double friction, double lag) {
    const std::size_t n = spans.shape(0), samples = s.size();
    if (front.size() != n || rear.size() != n || wanted.size() != n) throw nb::value_error("cells: columns of one length");
    for (std::size_t c = 0; c < n; ++c) {
        if (!wanted(c)) continue;
        const auto i = static_cast<std::size_t>(front(c)), j = static_cast<std::size_t>(rear(c));
        if (i >= samples || j >= samples) throw nb::value_error("cells: front and rear are samples");
        const lattice::Interval found = lag_interval(path, {s(i), s(j)}, {spans(c, 0), spans(c, 1)}, friction, lag);
        spans(c, 4) = found.lower, spans(c, 5) = found.upper;
    }
}

using PitchRows = In<std::int32_t, nb::shape<-1, 2>>;

Arrays leg_arrays(const HipGrid& grid, const RobotModel& robot, int pair, const In<std::int32_t, nb::ndim<1>>& like,
                  const Points& centres, const PitchRows& wanted, const Lattice& lattice, double thigh_slack) {
    const std::size_t n = centres.shape(0), m = static_cast<std::size_t>(grid.shape.parity_size());
    if (like.size() != n || wanted.shape(0) != n || (pair != kFront && pair != kRear)) throw nb::value_error("like, wanted: one for each centre");
    const std::size_t kinds = grid.cost.size() / (4 * m * m);
    std::vector<int> alike(like.data(), like.data() + n);
    std::vector<PitchRange> pitches(n);
    for (std::size_t i = 0; i < n; ++i) {
        pitches[i] = {wanted(i, 0), wanted(i, 1)};
        if (alike[i] < 0 || static_cast<std::size_t>(alike[i]) >= kinds) throw nb::value_error("like: a sample of the grid");
        if (pitches[i].first < 0 || pitches[i].last > lattice.pitches) throw nb::value_error("wanted: pitches of the lattice");
    }
    LegTableData table;
    {
        const std::vector<Vec2> wheels = points(centres);
        const nb::gil_scoped_release released;
        table = leg_table(grid, robot.legs[pair], alike, wheels, pitches, lattice, thigh_slack);
    }
    const std::size_t p = static_cast<std::size_t>(table.pitches), rows = static_cast<std::size_t>(table.rows);
    Arrays out;
    float* cost = table.cost.release();
    const nb::capsule owner(cost, [](void* at) noexcept { std::free(at); });
    out["cost"] = Array(nb::ndarray<nb::numpy, float>(cost, {n, p, rows, static_cast<std::size_t>(table.columns)}, owner));
    out["moment"] = owned(std::vector<float>(grid.moment), {2, 2, m, m});
    out["carried"] = owned(std::move(table.carried), {n});
    out["x0"] = owned(std::move(table.x0), {n, p});
    out["z0"] = owned(std::move(table.z0), {n, p});
    out["u"] = owned(std::move(table.u), {n, p});
    out["v"] = owned(std::move(table.v), {n, p});
    out["possible"] = owned(std::move(table.possible), {n, p, rows});
    return out;
}

}  // namespace

void bind_lattice_tables(nb::module_& m) {
    nb::class_<WindowShape>(m, "WindowShape")
        .def("__init__", [](WindowShape* self, const Lattice& lattice, int low) { new (self) WindowShape{lattice, low}; },
             nb::arg("lattice"), nb::arg("low"));
    nb::class_<TableWeights>(m, "TableWeights")
        .def("__init__", [](TableWeights* self, double clearance, double torque) { new (self) TableWeights{clearance, torque}; },
             nb::arg("clearance"), nb::arg("torque"));
    nb::class_<Tolerances>(m, "Tolerances")
        .def("__init__", [](Tolerances* self, double trunk, double links, double reach, double thigh) {
            new (self) Tolerances{trunk, links, reach, thigh};
        }, nb::arg("trunk"), nb::arg("links"), nb::arg("reach"), nb::arg("thigh"));
    nb::class_<HipGrid>(m, "HipGrid");
    m.def("sample_pairs", &pairs_found, nb::arg("centres"), nb::arg("near"), nb::arg("far"), nb::arg("front"), nb::arg("rear"),
          "Samples (n, 2) of front and rear wheels `near` to `far` apart, in lexicographic order.");
    m.def("pitch_ranges", [](const Points& centres, const Pairs& pairs, const WindowShape& shape) {
        const auto found = pitch_ranges(points(centres), sample_pairs_of(pairs, centres.shape(0)), shape);
        std::vector<std::int32_t> out;
        for (const auto& wheel : found)
            for (const PitchRange range : wheel) out.insert(out.end(), {range.first, range.last});
        return give(std::move(out), {2, centres.shape(0), 2});
    }, nb::arg("centres"), nb::arg("pairs"), nb::arg("shape"),
       "Pitches (2, n, 2) that any window of a sample looks at, with its wheel in front, then behind: first, last + 1.");
    m.def("cells", &cells_found, nb::arg("path"), nb::arg("s"), nb::arg("centres"), nb::arg("pairs"), nb::arg("shape"),
          nb::arg("friction"), nb::arg("reserve"), nb::arg("least_com_margin"), "Columns of the pairs that can stand at all, by name.");
    m.def("fill_lag_spans", &fill_lag_spans, nb::arg("path"), nb::arg("s"), nb::arg("front"), nb::arg("rear"), nb::arg("wanted"),
          nb::arg("spans").noconvert(), nb::arg("friction"), nb::arg("lag"), "Fill the last two columns of the wanted rows.");
    m.def("outlines", [](const Points& profile, const Points& centres, double reach) {
        if (profile.shape(0) < 2) throw nb::value_error("profile: two points at least");
        Outlines found = outlines(points(profile), points(centres), reach);
        const std::size_t width = found.width;
        return give(std::move(found.rows), {centres.shape(0), width});
    }, nb::arg("profile"), nb::arg("centres"), nb::arg("reach"),
       "Rows (n, k) of the ground within reach of each wheel's centre, from there [1e-7 m].");
    m.def("hip_grid", [](const Terrain& terrain, const RobotModel& robot, int pair, const Points& centres,
                         const In<std::int32_t, nb::ndim<1>>& wanted, double step, int half, const TableWeights& weights,
                         const Tolerances& tolerances) {
        if (half < 1 || half > 1000 || !(step > 0.0) || (pair != kFront && pair != kRear)) throw nb::value_error("pair: 0 or 1; step and half: above 0");
        std::vector<int> samples(wanted.data(), wanted.data() + wanted.size());
        for (const int i : samples)
            if (i < 0 || static_cast<std::size_t>(i) >= centres.shape(0)) throw nb::value_error("wanted: samples");
        const std::vector<Vec2> wheels = points(centres);
        const nb::gil_scoped_release released;
        return hip_grid(terrain, robot, pair, wheels, samples, {step, half}, weights, tolerances);
    }, nb::arg("terrain"), nb::arg("robot"), nb::arg("pair"), nb::arg("centres"), nb::arg("wanted"), nb::arg("step"),
       nb::arg("half"), nb::arg("weights"), nb::arg("tolerances"));
    m.def("leg_table", &leg_arrays, nb::arg("grid"), nb::arg("robot"), nb::arg("pair"), nb::arg("like"), nb::arg("centres"),
          nb::arg("pitches"), nb::arg("lattice"), nb::arg("thigh_slack"), "A leg on the body lattice: columns of LegTable by name.");
    m.def("leg_clearances", [](const Terrain& terrain, const Robot& robot, int pair, const In<double, nb::shape<2>>& hip,
                               const In<double, nb::shape<2>>& knee, const Points& wheels, double query_radius, double least) {
        if (wheels.shape(0) == 0 || (pair != kFront && pair != kRear)) throw nb::value_error("pair: 0 or 1; wheels: at least one");
        const std::vector<Vec2> centres = points(wheels);
        const MovingLeg moving = {{hip(0), hip(1)}, {knee(0), knee(1)}};
        std::vector<float> out(centres.size());
        const GroundNearWheels ground(terrain, centres, query_radius + 10.0);
        leg_clearances(terrain, ground, robot.legs[pair], moving, centres, query_radius, least, out);
        return give(std::move(out));
    }, nb::arg("terrain"), nb::arg("robot"), nb::arg("pair"), nb::arg("hip"), nb::arg("knee"), nb::arg("wheels"),
       nb::arg("query_radius"), nb::arg("least"), "Least clearances (n,) of a leg that moves with each wheel, x rising [m].");
    m.def("trunk_table", [](const Terrain& terrain, const RobotModel& robot, const WindowShape& shape, const TableWeights& weights,
                            double least_clearance, const Points& centres, const Pairs& pairs) {
        if (centres.shape(0) == 0) throw nb::value_error("centres: at least one");
        const std::vector<Vec2> wheels = points(centres);
        const std::vector<SamplePair> given = sample_pairs_of(pairs, wheels.size());
        TrunkTableData table;
        {
            const nb::gil_scoped_release released;
            table = trunk_table(terrain, robot, shape, weights, least_clearance, wheels, given);
        }
        const auto pitches = static_cast<std::size_t>(shape.lattice.pitches), rows = static_cast<std::size_t>(table.rows);
        const int x0 = table.x0, z0 = table.z0;
        const std::size_t stored = static_cast<std::size_t>(table.stored), columns = static_cast<std::size_t>(table.columns);
        return std::tuple(give(std::move(table.cost), {pitches, rows, stored}), give(std::move(table.possible), {pitches, rows, columns}), x0, z0);
    }, nb::arg("terrain"), nb::arg("robot"), nb::arg("shape"), nb::arg("weights"), nb::arg("least_clearance"), nb::arg("centres"),
       nb::arg("pairs"), "Costs (pitches, rows, columns) and bitsets of the trunk, and where column and row 0 lie.");
}

}  // namespace stairwright::python
