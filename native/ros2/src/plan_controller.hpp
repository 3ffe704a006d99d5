// The player as a controller of ros2_control: effort commands for all motors, 500 times a second or more often.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <controller_interface/controller_interface.hpp>

#include "stairwright/player/player.hpp"

namespace stairwright_controller {

// Parameters: `plan_file`, a path; `imu_name`, the sensor's ("imu"). Commands `<motor>/effort` and reads `<motor>/position,
// velocity, effort` of each motor that the plan file names, and `<imu>/angular_velocity.{x,y,z}` and
// `<imu>/linear_acceleration.{x,y,z}`. The plan begins when the controller is activated; deactivating it sets efforts to 0.
class PlanController : public controller_interface::ControllerInterface {
  public:
    controller_interface::CallbackReturn on_init() override;
    controller_interface::CallbackReturn on_configure(const rclcpp_lifecycle::State& previous) override;
    controller_interface::CallbackReturn on_activate(const rclcpp_lifecycle::State& previous) override;
    controller_interface::CallbackReturn on_deactivate(const rclcpp_lifecycle::State& previous) override;
    controller_interface::InterfaceConfiguration command_interface_configuration() const override;
    controller_interface::InterfaceConfiguration state_interface_configuration() const override;
    controller_interface::return_type update(const rclcpp::Time& time, const rclcpp::Duration& period) override;

  private:
    stairwright::player::PlanFile file_;
    std::string imu_;
    std::vector<std::size_t> motors_;  // numbers of those that are there
    std::unique_ptr<stairwright::player::Player> player_;
    stairwright::player::Phase phase_ = stairwright::player::Phase::waiting;
};

}  // namespace stairwright_controller
