#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stairwright/poses/between.hpp"
#include "stairwright/poses/footing.hpp"
#include "stairwright/poses/lagrangian.hpp"
#include "stairwright/poses/pose_record.hpp"
#include "stairwright/poses/quadratic_program.hpp"

namespace stairwright::python {

namespace {

using namespace poses;

using Rows5 = In<double, nb::shape<-1, 5>>;
using Rows7 = In<double, nb::shape<-1, 7>>;
using Rows3 = In<double, nb::shape<-1, 3>>;
using Rows4 = In<double, nb::shape<-1, 4>>;
using Rows2 = In<double, nb::shape<-1, 2>>;

template <nb::ssize_t N>
using Fixed = In<double, nb::shape<N>>;

template <nb::ssize_t N>
auto array(const In<double, nb::shape<N>>& a) {
    std::array<double, static_cast<std::size_t>(N)> out;
    std::copy_n(a.data(), N, out.begin());
    return out;
}

template <typename Rows, std::size_t N>
std::array<double, N> row(const Rows& rows, std::size_t k) {
    std::array<double, N> out;
    for (std::size_t j = 0; j < N; ++j) out[j] = rows(k, j);
    return out;
}

template <std::size_t N>
nb::ndarray<nb::numpy, double> numpy(const std::array<double, N>& values) {
    return give(std::vector<double>(values.begin(), values.end()));
}

// What arrays share: rows (n, ...) that `read` takes from each record.
template <typename Read>
nb::ndarray<nb::numpy, double> column(const std::vector<PoseRecord>& records, std::initializer_list<std::size_t> shape, Read read) {
    std::vector<double> out;
    for (const PoseRecord& record : records) read(record, out);
    return give(std::move(out), shape);
}

void append(std::vector<double>& out, Vec2 v) { out.insert(out.end(), {v.x, v.z}); }

using Arrays = nb::typed<nb::dict, nb::str, nb::ndarray<nb::numpy, double>>;

Arrays record_arrays(const std::vector<PoseRecord>& records, std::size_t points) {
    const std::size_t n = records.size();
    Arrays out;
    using Out = std::vector<double>&;
    out["q"] = column(records, {n, 4}, [](const PoseRecord& r, Out to) { to.insert(to.end(), r.q.begin(), r.q.end()); });
    out["wheels"] = column(records, {n, 2, 2}, [](const PoseRecord& r, Out to) { for (const Vec2 v : r.wheels) append(to, v); });
    out["contacts"] = column(records, {n, 2, 2}, [](const PoseRecord& r, Out to) { for (const Vec2 v : r.contacts) append(to, v); });
    out["forces"] = column(records, {n, 2, 2}, [](const PoseRecord& r, Out to) {
        for (const ContactForce& f : r.forces) to.insert(to.end(), {f.tangential, f.normal});
    });
    out["com"] = column(records, {n, 2}, [](const PoseRecord& r, Out to) { append(to, r.com); });
    out["collision_points"] = column(records, {n, points, 2}, [](const PoseRecord& r, Out to) {
        for (const Vec2 v : r.collision_points) append(to, v);
    });
    out["clearance"] = column(records, {n}, [](const PoseRecord& r, Out to) { to.push_back(r.clearance); });
    out["com_margin"] = column(records, {n}, [](const PoseRecord& r, Out to) { to.push_back(r.com_margin); });
    out["friction_margin"] = column(records, {n}, [](const PoseRecord& r, Out to) { to.push_back(r.friction_margin); });
    out["torque_margin"] = column(records, {n}, [](const PoseRecord& r, Out to) { to.push_back(r.torque_margin); });
    return out;
}

PoseState placed(const PoseProblem& problem, const Unknowns& y) {
    PoseState state(problem.robot);
    if (!place(problem.robot, problem.path, y, state)) throw nb::value_error("a leg does not reach its wheel");
    return state;
}

void bind_tasks(nb::module_& m) {
    nb::class_<PoseTask>(m, "PoseTask", "What is asked of one pose (eqs 17-22). SI units.")
        .def("__init__", [](PoseTask* self, const Fixed<7>& reference, const Fixed<7>& weights, const Fixed<9>& lower,
                            const Fixed<9>& upper, double clearance, double legs_distance, double behind, bool exact_links,
                            std::pair<double, double> com) {
            new (self) PoseTask{array(reference), array(weights), array(lower), array(upper), clearance, legs_distance, behind,
                                exact_links, {com.first, com.second}};
        }, nb::arg("reference"), nb::arg("weights"), nb::arg("lower"), nb::arg("upper"), nb::arg("clearance"),
           nb::arg("legs_distance"), nb::arg("behind"), nb::arg("exact_links"), nb::arg("com"));
    nb::class_<PoseRules>(m, "PoseRules", "What all poses of one plan keep. SI units.")
        .def("__init__", [](PoseRules* self, double friction, const Fixed<7>& weights, const Fixed<9>& lower, const Fixed<9>& upper,
                            double clearance, double legs_distance, double behind, bool exact_links) {
            new (self) PoseRules{friction, array(weights), array(lower), array(upper), clearance, legs_distance, behind, exact_links};
        }, nb::arg("friction"), nb::arg("weights"), nb::arg("lower"), nb::arg("upper"), nb::arg("clearance"),
           nb::arg("legs_distance"), nb::arg("behind"), nb::arg("exact_links"));
    nb::class_<ContactPair>(m, "ContactPair", "Where a pose is wanted: arc lengths [m].")
        .def("__init__", [](ContactPair* self, double front, std::pair<double, double> rear, bool ahead, double face, bool climbs,
                            const Fixed<5>& posture) {
            new (self) ContactPair{front, {rear.first, rear.second}, ahead, face, climbs, array(posture)};
        }, nb::arg("front"), nb::arg("rear"), nb::arg("ahead"), nb::arg("face"), nb::arg("climbs"), nb::arg("posture"));
    nb::class_<PoseSolution>(m, "PoseSolution")
        .def_prop_ro("x", [](const PoseSolution& s) { return numpy(s.x); }, nb::rv_policy::automatic)
        .def_ro("cost", &PoseSolution::cost)
        .def_ro("violation", &PoseSolution::violation)
        .def_ro("iterations", &PoseSolution::iterations);
    nb::class_<CriticalPose>(m, "CriticalPose")
        .def_ro("solution", &CriticalPose::solution)
        .def_ro("margin", &CriticalPose::margin)
        .def_ro("turn", &CriticalPose::turn);
}

void bind_problem(nb::module_& m) {
    const auto released = nb::call_guard<nb::gil_scoped_release>();
    nb::class_<PoseProblem>(m, "PoseProblem", "Pose optimisation for one robot on one terrain.")
        .def("__init__", [](PoseProblem* self, const Terrain& terrain, const WheelPath& path, const Robot& robot,
                            const Points& trunk, std::vector<double> thigh, std::vector<double> calf) {
            new (self) PoseProblem(terrain, path, robot, {points(trunk), std::move(thigh), std::move(calf)});
        }, nb::arg("terrain"), nb::arg("path"), nb::arg("robot"), nb::arg("trunk_points"), nb::arg("thigh_points"),
           nb::arg("calf_points"), nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>())
        .def_prop_ro("standing", [](const PoseProblem& p) { return numpy(p.robot.standing); }, nb::rv_policy::automatic, "Joints (4,) of the standing pose.")
        .def("reference_posture", [](const PoseProblem& p, double x) { return numpy(reference_posture(p, x)); })
        .def("solve", [](const PoseProblem& p, const PoseTask& task, const Fixed<5>& start) {
            return solve_pose(p, task, array(start));
        }, nb::arg("task"), nb::arg("start"), "From one first guess (x, z, pitch, s_front, s_rear).")
        .def("critical_pose", [](const PoseProblem& p, const PoseRules& rules, const ContactPair& pair, double rear,
                                 const Fixed<5>& start, bool patient) {
            return critical_pose(p, rules, pair, rear, array(start), patient);
        }, released)
        .def("critical_poses", [](const PoseProblem& p, const PoseRules& rules, const ContactPair& pair, const Vector& rears) {
            return critical_poses(p, rules, pair, {rears.data(), rears.data() + rears.size()});
        }, released)
        .def("move_poses", [](const PoseProblem& p, const PoseRules& rules, const Rows2& wheels, const Rows7& even, const Vector& com,
                              const Vector& shift, const Rows2& balance, const In<bool, nb::ndim<1>>& wanted, const Rows3& trunks,
                              const In<bool, nb::ndim<1>>& sound) {
            const std::size_t n = wheels.shape(0);
            for (const std::size_t count : {even.shape(0), com.size(), shift.size(), balance.shape(0), wanted.size(), trunks.shape(0), sound.size()})
                if (count != n) throw nb::value_error("as many of each as wheels, please");
            std::vector<PoseToMove> poses;
            std::vector<std::array<double, 3>> moved;
            std::vector<bool> good;
            std::vector<std::size_t> which;
            for (std::size_t k = 0; k < n; ++k) {
                poses.push_back({row<Rows2, 2>(wheels, k), row<Rows7, 7>(even, k), com(k), shift(k), {balance(k, 0), balance(k, 1)}});
                moved.push_back(row<Rows3, 3>(trunks, k));
                good.push_back(sound(k));
                if (wanted(k)) which.push_back(k);
            }
            {
                const nb::gil_scoped_release released;
                move_poses(p, rules, poses, which, moved, good);
            }
            std::vector<double> out;
            for (const auto& trunk : moved) out.insert(out.end(), trunk.begin(), trunk.end());
            return give(std::move(out), {n, 3});
        }, nb::arg("rules"), nb::arg("wheels"), nb::arg("even"), nb::arg("com"), nb::arg("shift"), nb::arg("balance"),
           nb::arg("wanted"), nb::arg("trunks"), nb::arg("sound"),
           "Trunks (n, 3), moved at the samples (n,) wanted: the clear pose nearest to the even one (n, 7) with its CoM (n,) "
           "shifted (n,) towards the interval of balance (n, 2).")
        .def("pose_slacks", [](const PoseProblem& p, const PoseRules& rules, const Rows5& y, const Rows2& com) {
            if (y.shape(0) != com.shape(0)) throw nb::value_error("as many intervals as poses, please");
            std::vector<double> slack, q;
            for (std::size_t k = 0; k < y.shape(0); ++k) {
                const PoseSlack found = pose_slack(p, rules, row<Rows5, 5>(y, k), {com(k, 0), com(k, 1)});
                slack.push_back(found.least);
                q.insert(q.end(), found.q.begin(), found.q.end());
            }
            const std::size_t n = slack.size();
            return std::pair(give(std::move(slack)), give(std::move(q), {n, 4}));
        }, "Least slacks (n,) and joints (n, 4) of poses (n, 5) with CoM intervals (n, 2).")
        .def("balance_lost", [](const PoseProblem& p, const PoseRules& rules, const Fixed<9>& begin, const Fixed<9>& end) {
            return balance_lost(p, rules, array(begin), array(end));
        }, released)
        .def("pose_records", [](const PoseProblem& p, double friction, const Rows5& y, const Rows4& q) {
            if (y.shape(0) != q.shape(0)) throw nb::value_error("as many joints as poses, please");
            std::vector<PoseRecord> records;
            for (std::size_t k = 0; k < y.shape(0); ++k)
                records.push_back(pose_record(p, friction, row<Rows5, 5>(y, k), row<Rows4, 4>(q, k)));
            const auto points = static_cast<std::size_t>(p.robot.last_collision_point - p.robot.first_collision_point);
            return record_arrays(records, points);
        }, "What documents of poses (n, 5) state, by name; joints (n, 4) count where a leg is out of reach.")
        .def("constraints", [](const PoseProblem& p, const PoseTask& task, const Fixed<5>& y) {
            const PoseState state = placed(p, array(y));
            Constraints near;
            collect(p.robot, p.cells, task, state, near);
            std::vector<int> labels;
            std::vector<double> values, gradients;
            for (const Constraint& c : near.rows) {
                labels.insert(labels.end(), {static_cast<int>(c.kind), c.i, c.j, c.k});
                values.push_back(c.value);
                const GradientY g = reduce(state, gradient(state, c));
                gradients.insert(gradients.end(), g.begin(), g.end());
            }
            const std::size_t n = near.rows.size();
            return std::tuple(give(std::move(labels), {n, 4}), give(std::move(values)), give(std::move(gradients), {n, 5}), near.least);
        }, "Rows near their bounds: kind and points (n, 4), values (n,), gradients (n, 5); the least slack of all.")
        .def("lagrangian", [](const PoseProblem& p, const PoseTask& task, const Fixed<5>& y, const Vector& multipliers) {
            const PoseState state = placed(p, array(y));
            Constraints near;
            collect(p.robot, p.cells, task, state, near);
            if (multipliers.size() != near.rows.size()) throw nb::value_error("one multiplier for each row, please");
            GradientY g;
            HessianY h;
            lagrangian(p.robot, task, state, {near.rows, {multipliers.data(), multipliers.data() + multipliers.size()}}, g, h);
            std::vector<double> flat;
            for (const GradientY& line : h) flat.insert(flat.end(), line.begin(), line.end());
            return std::pair(numpy(g), give(std::move(flat), {kUnknowns, kUnknowns}));
        }, "Gradient (5,) of the cost and Hessian (5, 5) of the Lagrangian.")
        .def("points", [](const PoseProblem& p, const Fixed<5>& y) {
            const PoseState state = placed(p, array(y));
            std::vector<double> skeleton;
            for (const auto& joint : {p.robot.hip, p.robot.knee, p.robot.wheel})
                for (const int i : joint) append(skeleton, state.points[i].at);
            append(skeleton, state.com.at);
            return std::pair(give(std::move(skeleton), {7, 2}), numpy(state.q));
        }, "Hips, knees, wheels (front, rear) and CoM (7, 2), and joints (4,).");
}

}  // namespace

void bind_poses(nb::module_& m) {
    bind_tasks(m);
    bind_problem(m);
    m.attr("SOLVED") = kSolved;
    m.attr("WANTED_MARGIN") = kWantedMargin;
    m.attr("REAR_SPACING") = kRearSpacing;
    m.attr("CLEARANCE_BETWEEN") = kClearanceBetween;
    m.attr("ENOUGH_POSES") = kEnough;
    m.def("rear_places", [](const WheelPath& path, double front, double face, std::pair<double, double> rear,
                            std::pair<double, double> distance, double usual_distance, double step, double friction,
                            double scale, bool resting) {
        return give(rear_places(path, {front, face, {rear.first, rear.second}, {distance.first, distance.second},
                                       usual_distance, step, friction, scale, resting}));
    }, nb::arg("path"), nb::arg("front"), nb::arg("face"), nb::arg("rear"), nb::arg("distance"), nb::arg("usual_distance"),
       nb::arg("step"), nb::arg("friction"), nb::arg("scale"), nb::arg("resting"));
    m.def("rests", &rests, nb::arg("path"), nb::arg("s"), nb::arg("friction"), nb::arg("scale"));
    m.def("steep_ahead", &steep_ahead, nb::arg("path"), nb::arg("s"), nb::arg("friction"), nb::arg("scale"));
    m.def("solve_quadratic_program", [](const In<double, nb::ndim<2>>& h, const Vector& g, const In<double, nb::ndim<2>>& a, const Vector& b) {
        const std::size_t n = g.size(), rows = b.size();
        if (n > kMostVariables || h.shape(0) != n || h.shape(1) != n || a.shape(0) != rows || (rows > 0 && a.shape(1) != n))
            throw nb::value_error("H (n, n), g (n,), A (m, n), b (m,) with n of at most 6");
        QuadraticProgram program;
        program.n = static_cast<int>(n);
        for (std::size_t i = 0; i < n; ++i) {
            program.gradient[i] = g(i);
            for (std::size_t j = 0; j < n; ++j) program.hessian[i][j] = h(i, j);
        }
        for (std::size_t i = 0; i < rows; ++i) {
            QpVector line{};
            for (std::size_t j = 0; j < n; ++j) line[j] = a(i, j);
            program.rows.push_back(line);
            program.bounds.push_back(b(i));
        }
        QpVector x{};
        std::vector<double> multipliers;
        const QpStatus status = program.solve(x, multipliers);
        return std::tuple(static_cast<int>(status), give(std::vector<double>(x.begin(), x.begin() + program.n)), give(std::move(multipliers)));
    }, "Minimise x'Hx/2 + g'x with A x >= b: status (0 solved, 1 infeasible, 2 stalled), x, multipliers.");
}

}  // namespace stairwright::python
