// A plan as the player reads it: a text file, a key and its numbers a line.
//
//   stairwright-player 1                 first line: format and version
//   # ...                                a comment
//   friction 0.6                         and so on: keys in any order, `vertex` and `row` in theirs
//   front.thigh 0 -0.213 ...             see plan_file.cpp for the numbers of each key
//   motor 1 FR_thigh drive 3 1 0         number, name, joint of ours, sign and offset: ours = sign theirs + offset
//   motor 0 FR_hip hold 0.1              kept at an angle of its own
//   motor 0 FR_hip none                  not there
//   facing -1                            the robot's rear leads (1 if left out)
//   vertex -1.5 0                        of the terrain [m]
//   row 0.12 ...                         allowed speed [m/s], then the 41 numbers of control::Reference
#pragma once

#include <istream>
#include <string>

#include "stairwright/control/controller.hpp"
#include "stairwright/player/low_level.hpp"

namespace stairwright::player {

// What a motor of the robot is to the plan.
struct MotorRole {
    enum class Kind { none, drive, hold };

    std::string name;
    Kind kind = Kind::none;
    std::size_t joint = 0;             // of ours, where it drives one
    double sign = 1.0, offset = 0.0;   // ours = sign theirs + offset [rad]
    double angle = 0.0;                // where it is held, the robot's own angle [rad]
};

struct PlanFile {
    std::string plan;          // its id
    Robot robot;
    std::vector<Vec2> terrain; // m
    double friction = 0.0;     // that the plan was made for
    double facing = 1.0;       // -1 where the robot's rear leads: x and y of its IMU point the other way
    control::Gains gains;
    std::vector<control::Reference> rows;
    std::vector<double> speeds;          // m/s, allowed at each row
    double position = 0.0, step = 0.0;   // of the first row, and between rows [m]
    double lead = 0.0;                   // how far the plan may be ahead of the wheels [m]
    double settle = 0.0;                 // s at rest before the plan starts
    double grip_need = 0.0, grip_enough = 0.0;  // friction that is tested for, and what will do [1]
    double hold_stiffness = 0.0, hold_damping = 0.0;  // of motors that are held [Nm/rad, Nm s/rad]
    std::array<MotorRole, kMotors> motors;
};

// Throws std::runtime_error, with the line where there is one, if it is not such a file.
PlanFile read_plan_file(std::istream& text);

}  // namespace stairwright::player
