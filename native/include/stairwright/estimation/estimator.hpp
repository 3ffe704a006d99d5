// Where the robot is on the map, from its own sensors: an error-state Kalman filter relative to the terrain.
//
// Gyro and accelerometer drive the prediction; wheels that carry load measure. Of each:
//   rolling   the wheel's centre moves along the face as fast as the wheel turns, and neither off it nor sideways
//             (contact-aided filtering: Bloesch et al. 2013, Hartley et al. 2020; here the contact rolls);
//   place     the wheel's centre lies on the map's wheel-centre curve, see curve_match.hpp: along the normal of the
//             face, so a tread says how high the robot is and a face how far along;
//   corner    both faces are felt: a fix. A wheel that seems to be beyond a steep face without feeling it is put back
//             to it (the mean alone: not to feel a face is the same news at every step).
// Nothing global is measured. Place and rolling are measured at every step although their errors last longer than one,
// so their variances are multiplied by how many steps they last. What does not fit (slip, a wheel in the air) is left
// out by its normalised innovation.
//
// Refs: R. Hartley, M. Ghaffari, R. Eustice, J. Grizzle, "Contact-aided invariant extended Kalman filtering for robot
// state estimation", IJRR 2020. M. Bloesch et al., "State estimation for legged robots", RSS 2013. J. Sola,
// "Quaternion kinematics for the error-state Kalman filter", 2017. J. Neira, J. Tardos, "Data association in stochastic
// mapping using the joint compatibility test", 2001.
#pragma once

#include <optional>
#include <vector>

#include "stairwright/control/controller.hpp"
#include "stairwright/estimation/curve_match.hpp"
#include "stairwright/estimation/error_state.hpp"
#include "stairwright/estimation/readings.hpp"
#include "stairwright/estimation/wheel_forces.hpp"

namespace stairwright::estimation {

// Standard deviations; SI units.
struct Noise {
    // At the start, of what is believed there.
    double start_place = 0.03, start_height = 0.003, start_tilt = 0.02, start_heading = 0.04;
    double start_gyro_bias = 0.01, start_force_bias = 0.2, scale = 0.01;
    // Of the sensors, a reading.
    double gyro = 0.02, specific_force = 0.5, joint_rate = 0.05;
    // Growth in the square root of a second.
    double gyro_bias = 2e-4, force_bias = 5e-3;
    // Growth of the map's error in the square root of a metre rolled, and of measurements.
    double map_along = 0.006, map_height = 0.004;
    // Of the place of a face against the one before, and of the height of a tread [m].
    double face_place = 0.025, tread_height = 0.010;
    // Of the ground sideways, which the map has level: kerbs and ramps may slope by 2 % (ADA Standards 405.3) [rad].
    double cross_slope = 0.010;
    double place = 0.002, rolling = 0.03, aside = 0.03, off_face = 0.02;
    // A loaded tyre rolls on a radius that is smaller by this [m].
    double deflection = 0.0004;
    double creep = control::kCreep;
    // How long an error of these lasts [s].
    double place_lasts = 0.06, rolling_lasts = 0.02;
    // Of the force that a leg feels, in robot weights.
    double force = 0.08;
};

// What is known before the first reading.
struct Start {
    Vec2 place;          // of the trunk point [m]
    double pitch = 0.0;
};

// A face or a tread that the front wheels have found elsewhere than on the map.
struct MapError {
    bool face = false;  // else a tread
    double s = 0.0;     // where on the wheel-centre curve [m]
    Vec2 off;           // the map less what was found [m]; of a face x counts, of a tread z
    // How many pairs, the front one first, the estimate has with that offset: rear ones are on the same ground, or know of
    // it already; none where a face stops wheels that seem to be on the way to it.
    int pairs = 1;
};

// What the filter says of itself.
struct Estimate {
    control::RobotState state;       // for the controller: on the map as it was drawn
    std::array<double, 4> places{};  // of the wheels on the wheel-centre curve [m]
    std::array<bool, 4> touching{};
    // How much farther ahead and higher each pair's ground lies than drawn, against their mean [m].
    std::array<Vec2, 2> ground{};
    std::array<bool, 2> on_tread{};   // of each pair: it can roll on for a while
    std::array<bool, 2> nearing{};    // of each pair: on a tread, near to the next face
    // The ground's force on each wheel, world x-z, where all legs tell theirs [N].
    std::optional<std::array<Vec2, 4>> felt;
    std::array<double, 4> used_grip{};  // tangential force over normal force of each wheel, as the legs feel them
    std::array<bool, 2> hanging{};    // a wheel of the pair stays in the air where the map has it pass a corner
    std::optional<MapError> map_error;
    std::array<bool, 2> searching{};  // the map has a face where the pair is, and it feels none
    bool lost = false;                // the ground is farther from where the map has it than any map is wrong
    std::array<double, 2> found{};    // how much farther on each pair is by what a wheel in a corner measured at this step [m]
};

class Estimator {
  public:
    Estimator(Robot robot, WheelPath path, const Start& start, const Noise& noise);

    // One step of time `dt` on; returns the estimate after it.
    const Estimate& step(const Readings& readings, double dt);

    // How much slower than they roll the wheels move, see Noise [m/s].
    void believe_creep(double creep) { noise_.creep = creep; }
    // What the robot is from now on: the same one with other masses.
    void believe(const Robot& robot) { robot_ = robot, weight_ = robot.mass() * kGravity; }
    // Another map from now on, on which the face or tread of `found` is where it was found. Returns by how much the robot's
    // place on the map is another one by that [m].
    Vec2 correct_map(WheelPath path, const MapError& found);

    const Estimate& estimate() const { return estimate_; }
    // Error of attitude (world frame), velocity and place, as far as the filter estimates them, and the
    // normalised square of roll, pitch, x and z velocity, and place (NEES, 6 degrees of freedom).
    struct Judgement {
        std::array<double, 8> error;
        double nees;                  // where the map is the world
        double nees_in_world;         // where faces and cross slope may be off by what Noise has
        double scale;                 // of the wheels, as estimated
        std::array<Vec2, 2> offset;   // of the map under front and rear wheels, as estimated [m]
    };
    Judgement judge(const control::RobotState& truth) const;

  private:
    // Pieces of the curve from tread to tread that may be none, see low_edges.cpp: an arc, and a face that leads to it or from it.
    struct LowEdge {
        std::size_t first, last;
        bool up;
    };
    struct WheelState {
        Vec2 place, rate;         // in the trunk frame, and its rate there [m, m/s]
        LegPlaces leg;            // world, with the trunk point as origin
        Vec2 felt;                // the force, smoothed [N]
        Vec2 felt_slowly;         // the same, smoothed once more
        double unsteady = 0.0;    // by how much it has changed lately [N]
        double traction = 0.0;    // smoothed [N]
        Vec2 velocity;            // of its centre, smoothed [m/s]
        Vec2 velocity_lag;        // what that lags behind by, about [m/s]
        Vec2 felt_before;         // both until the reading before this one
        double traction_before = 0.0;
        double s;                 // place on the curve [m]
        std::size_t recalled = 0;  // the last piece on which it has recalled what front wheels found
        std::array<std::size_t, 2> told{};  // pieces of which they had found something then, 0 for none
        std::size_t face = 0;  // piece of the curve, the last straight one
        std::size_t clear = 0, clear_before = 0;  // the last faces and treads that it was on clear of corners
        double since_clear = 0.0;  // how far it has come since [m]
        std::optional<LowEdge> low_edge;  // the one near to it
        bool missed = false;      // it is put back now
        bool follows = false;     // a steep face of which it has felt the foot or the edge
        std::size_t rounded = 0;  // the last piece round an edge on which it was felt
        bool contradicts = false; // it rolls otherwise than the filter can believe
        double put_back = 0.0;    // how far it has been put back on that piece, see Estimator::put_back [m]
        double rolled = 0.0;      // by the last step [m]
        double rate_now = 0.0;    // absolute, of its turning [rad/s]
        double cruise = 0.0;      // speed that it rolled at until the reading before this one, smoothed [m/s]
        bool on_face = false;     // a steep one, or in a corner before one
        double known = 0.0;       // for how long it has been there, or on a tread [s]
        double stopped = 0.0;     // evidence that it is at the face ahead already, see face_ahead.cpp
        Vec2 early;               // and by how much the map is off then [m]
        double force_deviation = 0.0;  // of what is felt [N]
        double least_push = 0.0;       // of a wall: more than that counts [N]
        double met = -1e9;        // the last corner of which it has felt the wall [m]
        double aloft = 0.0;       // for how long it has been in the air [s]
        double landed = 0.0;      // since it has met the face or tread that it is on [s]
        double leaps = 0.0;       // s for which it has seemed to be elsewhere round an edge
        double at_corner = 0.0;   // for how long it has felt both faces of a corner [s]
    };
    // Where a wheel's centre is believed to be [m], and how that changes with the state.
    struct WheelPlace {
        Vec2 centre;
        Error along_x{}, along_z{};
    };
    using Vec3 = std::array<double, 3>;
    using Rotation = std::array<Vec3, 3>;

    Rotation rotation() const;
    void predict(const Readings& readings, double dt);
    void see_legs(const Readings& readings, double dt);
    void feel_ground(const std::array<WheelForce, 4>& told, const Readings& readings, double dt);
    void measure(int wheel, const Readings& readings, double dt);
    Vec3 arm_of(int wheel) const;       // of its centre, in the trunk frame [m]
    Vec3 velocity_of(int wheel) const;  // of its centre, in the world [m/s]
    WheelPlace place_of(int wheel) const;
    WheelBelief believed(int wheel, const WheelPlace& place, double dt);
    void doubt_low_edges(WheelState& wheel, WheelBelief& belief) const;
    void look_at_velocity(const WheelState& wheel, WheelBelief& belief) const;
    bool touches(const WheelState& wheel, const CurveMatch& on) const;
    bool follows(const WheelState& wheel, const CurveMatch& on) const;
    void follow(int wheel, const CurveMatch& on, const WheelBelief& belief, bool touching, double dt);
    static bool is_passing(const WheelState& wheel, const CurveMatch& on);
    static bool is_leaping(const WheelState& wheel);
    void look_ahead(int wheel, const CurveMatch& on);
    void put_back(int wheel, const Error& along, double excess, Error& error);
    void compare_with_map(int wheel, const CurveMatch& on, const Spread& spread, double dt);
    void find_map_error();
    void feel_face_ahead(WheelState& wheel, const CurveMatch& on, const WheelBelief& belief, double dt);
    std::optional<MapError> face_ahead() const;
    void believe_wheels_again(double dt);
    std::size_t clear_on(const WheelState& wheel, const CurveMatch& on) const;
    void enter_face(int wheel, const CurveMatch& on);
    // What front wheels find of a face or tread the rear wheels know when they get there.
    bool has_found(std::size_t piece) const { return piece < found_.size() && found_[piece]; }
    void believe_map(std::size_t face);
    void pass(std::size_t face);
    void recall(WheelState& rear);
    void come_to_landing();
    bool rear_knows(double s, bool face) const;
    std::size_t face_or_tread(double s, bool face) const;  // the piece nearest to the place `s`
    bool is_face(std::size_t piece) const;
    std::size_t last_face(std::size_t from, std::size_t to) const;
    bool is_low_drop(std::size_t piece) const;
    Vec2 across(std::size_t piece) const;
    Vec2 normal(std::size_t piece) const;  // where it begins
    std::size_t face_below(std::size_t piece) const;
    bool before_drop(const CurveMatch& on) const;
    void note_low_edges();
    bool is_near(const WheelState& wheel, std::size_t first, std::size_t last) const;
    void leave_low_edge(int wheel, const CurveMatch& on, const WheelPlace& place, Error& error);
    bool over_low_edge(const WheelState& wheel, const CurveMatch& on) const;
    double nearest_corner(double s) const;  // along the curve, to the place `s` on it [m]
    void measure_place(int wheel, const CurveMatch& on, const WheelPlace& place, double dt, Error& error);
    void measure_turn(int wheel, Vec2 normal, Error along, double dt, Error& error);
    void measure_rolling(int wheel, const CurveMatch& on, const Readings& readings, const WheelPlace& place, double dt, Error& error);
    void correct(const Error& error);
    void report(const Readings& readings);

    Robot robot_;
    WheelPath path_;
    Noise noise_;
    double weight_;
    std::array<double, 4> attitude_;  // trunk to world, w x y z
    Vec3 velocity_{}, gyro_bias_{}, force_bias_{}, rate_{};
    Vec2 place_;
    std::array<Vec2, 2> offset_{};
    double scale_ = 0.0;
    bool started_ = false;
    bool landed_ = false;        // all wheels are on the landing, and agree on how far that is off
    double contradicted_ = 0.0;  // for how long by all wheels that touch [s]
    Covariance covariance_;
    std::array<WheelState, 4> wheels_;
    std::vector<LowEdge> low_edges_;
    std::vector<std::size_t> low_drops_;  // pieces of the curve, see low_edges.cpp
    std::vector<std::optional<double>> found_;  // of each piece, by front wheels: offset along of a face, up of a tread [m]
    double settled_ = 0.0;  // what of the offset up front wheels found on the last tread [m]
    Estimate estimate_;
};

}  // namespace stairwright::estimation
