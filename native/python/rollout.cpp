#include "stairwright/rollout/rollout.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>

#include "arrays.hpp"
#include "bindings.hpp"

namespace stairwright::python {

namespace {

using namespace control;
using namespace rollout;
using rollout::Rollout;

using Row = In<double, nb::shape<static_cast<nb::ssize_t>(kReferenceWidth)>>;
using Rows = In<double, nb::shape<-1, static_cast<nb::ssize_t>(kReferenceWidth)>>;
using Noise = In<double, nb::shape<-1, static_cast<nb::ssize_t>(kNoiseWidth)>>;

Reference reference(const double* row) {
    std::array<double, kReferenceWidth> numbers;
    std::copy_n(row, kReferenceWidth, numbers.begin());
    return std::bit_cast<Reference>(numbers);
}

std::vector<Reference> references(const Rows& rows) {
    std::vector<Reference> out;
    for (std::size_t i = 0; i < rows.shape(0); ++i) out.push_back(reference(rows.data() + i * kReferenceWidth));
    return out;
}

auto row(const Reference& target) {
    const auto numbers = std::bit_cast<std::array<double, kReferenceWidth>>(target);
    return give(std::vector<double>(numbers.begin(), numbers.end()));
}

auto samples(const Rollout& run, std::size_t first, std::size_t stride) {
    if (stride < 1) throw std::invalid_argument("stride must be at least 1");
    std::vector<double> out;
    const auto& kept = run.log().samples();
    std::size_t count = 0;
    for (std::size_t i = first; i < kept.size(); i += stride, ++count) {
        const auto numbers = std::bit_cast<std::array<double, kSampleWidth>>(kept[i]);
        out.insert(out.end(), numbers.begin(), numbers.end());
    }
    return give(std::move(out), {count, kSampleWidth});
}

void bind_follower(nb::module_& m) {
    nb::class_<PlanFollower>(m, "PlanFollower", "Advances a plan, with a largest lead over the robot.")
        .def("__init__", [](PlanFollower* self, double start, double step, const Rows& rows, const Vector& speeds, double maximum_lead) {
            new (self) PlanFollower(start, step, references(rows), {speeds.data(), speeds.data() + speeds.size()}, maximum_lead);
        }, nb::arg("start"), nb::arg("step"), nb::arg("rows"), nb::arg("speeds"), nb::arg("maximum_lead"))
        .def("advance", [](PlanFollower& self, const In<double, nb::shape<4>>& places, bool moving, double dt) {
            return row(self.advance({places(0), places(1), places(2), places(3)}, moving ? Motion::go : Motion::stop, dt));
        }, nb::arg("places"), nb::arg("moving"), nb::arg("dt"), nb::rv_policy::automatic, "The next set point (33,).")
        .def_prop_ro("position", &PlanFollower::position)
        .def_prop_ro("rate", &PlanFollower::rate)
        .def_prop_ro("lag", &PlanFollower::lag)
        .def_prop_ro("target", [](const PlanFollower& f) { return row(f.target()); }, nb::rv_policy::automatic);
}

auto judged(const Rollout& run) {
    std::vector<double> out;
    for (const Judged& row : run.judged()) {
        const auto numbers = std::bit_cast<std::array<double, kJudgedWidth>>(row);
        out.insert(out.end(), numbers.begin(), numbers.end());
    }
    const std::size_t count = run.judged().size();
    return give(std::move(out), {count, kJudgedWidth});
}

void bind_perception(nb::module_& m) {
    nb::class_<SensorModel>(m, "IdealSense", "The whole state, with noise and late; what is believed may be wrong all the time.")
        .def("__init__", [](SensorModel* self, std::size_t delay_steps, double start, double offset, double scale, double pitch) {
            new (self) SensorModel(delay_steps, {start, offset, scale, pitch});
        }, nb::arg("delay_steps"), nb::arg("start"), nb::arg("offset") = 0.0, nb::arg("scale") = 0.0, nb::arg("pitch") = 0.0);
    nb::class_<SensorErrors>(m, "SensorErrors", "Of the robot's own sensors, see rollout/robot_sensors.hpp.")
        .def("__init__", [](SensorErrors* self, double scale) { new (self) SensorErrors(usual_errors(scale)); }, nb::arg("scale") = 1.0)
        .def_rw("gyro", &SensorErrors::gyro)
        .def_rw("specific_force", &SensorErrors::specific_force)
        .def_rw("gyro_offset", &SensorErrors::gyro_offset)
        .def_rw("force_offset", &SensorErrors::force_offset)
        .def_rw("wheel_scale", &SensorErrors::wheel_scale)
        .def_rw("tilt", &SensorErrors::tilt);
    using Torques12 = In<double, nb::shape<12>>;
    nb::class_<RobotSensors>(m, "RobotSensors", "What a robot's own sensors say of the true state, see rollout/robot_sensors.hpp.")
        .def(nb::init<const Robot&, const SensorErrors&, std::uint64_t>(), nb::arg("robot"), nb::arg("errors"), nb::arg("seed"))
        .def("read", [](RobotSensors& self, const In<double, nb::shape<19>>& qpos, const In<double, nb::shape<18>>& qvel, const Torques12& torques, double dt) {
            std::array<double, kPositions + kVelocities> numbers;
            std::copy_n(qpos.data(), kPositions, numbers.begin());
            std::copy_n(qvel.data(), kVelocities, numbers.begin() + kPositions);
            control::Torques acted;
            std::copy_n(torques.data(), 12, acted.begin());
            const estimation::Readings out = self.read(std::bit_cast<RobotState>(numbers), acted, dt);
            return std::tuple(out.joints, out.joint_rates, out.torques, out.angular_rate, out.specific_force);
        }, nb::arg("qpos"), nb::arg("qvel"), nb::arg("torques"), nb::arg("dt"),
           "Joints, their rates and torques (12 each), angular rate and specific force of the trunk (3 each).");
    nb::class_<RobotSense>(m, "RobotSense", "The robot's own sensors, late, and the estimator.")
        .def("__init__", [](RobotSense* self, const Robot& robot, const WheelPath& path, std::array<double, 2> start, double pitch,
                            const SensorErrors& errors, std::size_t delay_steps, std::uint64_t seed,
                            const estimation::Noise& believed) {
            new (self) RobotSense({robot, errors, seed}, {robot, path, {{start[0], start[1]}, pitch}, believed}, delay_steps);
        }, nb::arg("robot"), nb::arg("path"), nb::arg("start"), nb::arg("pitch"), nb::arg("errors"), nb::arg("delay_steps"),
           nb::arg("seed"), nb::arg("believed") = estimation::Noise{});
}

}  // namespace

void bind_rollout(nb::module_& m) {
    bind_follower(m);
    bind_perception(m);
    nb::class_<Score>(m, "Score")
        .def_ro("pitch_error_max", &Score::pitch_error_max)
        .def_ro("pitch_error_squares", &Score::pitch_error_squares)
        .def_ro("joint_error_squares", &Score::joint_error_squares)
        .def_ro("leg_torque_max", &Score::leg_torque_max)
        .def_ro("wheel_torque_max", &Score::wheel_torque_max)
        .def_ro("energy", &Score::energy)
        .def_ro("steps", &Score::steps)
        .def_ro("pitch_error", &Score::pitch_error)
        .def_ro("tilt", &Score::tilt);
    nb::class_<Rollout>(m, "Rollout", "The closed loop in MuJoCo; keep model and data alive as long as it.")
        .def("__init__", [](Rollout* self, std::uintptr_t model, std::uintptr_t data, const Controller& controller,
                            const PlanFollower& follower, const Perception& perception, double motor_bandwidth,
                            double torque_scale, std::size_t log_every, int substeps, double grip_need, bool mends_map) {
            if (model == 0 || data == 0) throw std::invalid_argument("model and data must be addresses");
            new (self) Rollout(reinterpret_cast<const mjModel_*>(model), reinterpret_cast<mjData_*>(data), controller, follower,
                               perception, {motor_bandwidth, torque_scale}, log_every, substeps, grip_need, mends_map);
        }, nb::arg("model"), nb::arg("data"), nb::arg("controller"), nb::arg("follower"), nb::arg("perception"),
           nb::arg("motor_bandwidth"), nb::arg("torque_scale"), nb::arg("log_every"), nb::arg("substeps"),
           nb::arg("grip_need") = 0.0, nb::arg("mends_map") = false)
        .def("run", [](Rollout& self, int first, int last, bool looked, bool loaded, bool moving, double begun, const Noise& noise) {
            nb::gil_scoped_release release;
            return self.run({std::max(first, 0), last, looked, loaded, moving, begun}, {noise.data(), noise.size()});
        }, nb::arg("first"), nb::arg("last"), nb::arg("looked"), nb::arg("loaded"), nb::arg("moving"), nb::arg("begun"), nb::arg("noise"),
           "Control steps; returns where it stopped to have contacts looked at, or `last`.")
        .def("give_up", [](Rollout& r) { r.executor().give_up(); }, "The robot stops where it waits, and stands.")
        .def("go_on", [](Rollout& r) { r.executor().go_on(); }, "The plan goes on after a test of the grip in which wheels slipped.")
        .def("adopt", [](Rollout& r, const PlanFollower& follower, double friction) { r.executor().adopt(follower, friction); },
             nb::arg("follower"), nb::arg("friction"), "Another plan from now on, made for `friction`.")
        .def("tolerate", [](Rollout& r, double height, double place) { r.executor().tolerate(height, place); }, nb::arg("height"), nb::arg("place"),
             "Errors of the map at which the robot does not wait: each tread by so much up, each face along [m].")
        .def("correct_map", &Rollout::correct_map, nb::arg("path"), "A map on which `map_error` is mended; another plan has to follow.")
        .def("carry", &Rollout::carry, nb::arg("robot"), nb::arg("grip_need"),
             "The robot as the weighing found it from now on, which tests the ground for that friction; another plan has to follow.")
        .def_prop_ro("load", [](const Rollout& r) -> std::optional<std::tuple<double, Vec2, Vec2>> {
            const auto& load = r.executor().load();
            if (!load) return {};
            return std::tuple(load->mass, load->place, load->shift);
        }, "What the weighing before the start found and nobody has told of, in the trunk's frame: mass [kg] and its place [m], of which\n"
           "z is not a number where the robot could not nod, or, where that mass is 0, the shift of the robot's mass centre [m].")
        .def_prop_ro("map_error", [](const Rollout& r) -> std::optional<std::tuple<bool, double, double, double, int>> {
            const auto& found = r.executor().map_error();
            if (!found) return {};
            return std::tuple(found->face, found->s, found->off.x, found->off.z, found->pairs);
        }, "What the front wheels found elsewhere than on the map, while the robot waits: whether it is a face, its place on the\n"
           "wheel-centre curve, by how much the map is off along and up [m], and how many pairs of\n"
           "wheels, the front one first, are off with it on the map.")
        .def_prop_ro("places", [](const Rollout& r) { return r.executor().controller().places(); }, "Of the wheels on the wheel-centre curve [m].")
        .def_prop_ro("slipped", [](const Rollout& r) -> std::optional<std::pair<double, bool>> {
            const auto& slipped = r.executor().slipped();
            if (!slipped) return {};
            return std::pair(slipped->found, slipped->front);
        }, "Friction at which wheels slipped in the test before the start, and whether the front ones did.")
        .def_prop_ro("waits", [](const Rollout& r) { return r.executor().waits(); }, "Whether the robot stands until it is told to go on.")
        .def("diverged", &Rollout::diverged)
        .def_prop_ro("stopped", [](const Rollout& r) { return r.executor().stop() != control::Stop::none; }, "Whether the robot has given up.")
        .def_prop_ro("stop_reason", [](const Rollout& r) { return control::reason(r.executor().stop()); }, "Why it has; empty where it has not.")
        .def_prop_ro("may_go_on", [](const Rollout& r) { return control::may_go_on(r.executor().stop()); },
                     "Whether another plan, from where it stands, may lead on.")
        .def_prop_ro("stopped_at", [](const Rollout& r) { return r.executor().stopped_at(); }, "Since when [s].")
        .def_prop_ro("position", [](const Rollout& r) { return r.executor().follower().position(); })
        .def_prop_ro("target", [](const Rollout& r) { return row(r.executor().target()); }, nb::rv_policy::automatic)
        .def_prop_ro("score", [](const Rollout& r) { return r.score(); })
        .def_prop_ro("judged", &judged, nb::rv_policy::automatic,
                     "Rows (n, 16) of the estimator against the truth: time, errors of attitude, velocity, place x and z; NEES;\n"
                     "the estimated scale of the wheels and offsets of the map under front and rear wheels; NEES where the map may be off.")
        .def_prop_ro("sample_count", [](const Rollout& r) { return r.log().samples().size(); })
        .def("samples", &samples, nb::arg("first") = 0, nb::arg("stride") = 1, nb::rv_policy::automatic,
             "Rows of the log, see rollout/log.hpp.");
}

}  // namespace stairwright::python
