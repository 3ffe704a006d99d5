#include "plan_controller.hpp"

#include <cmath>
#include <exception>
#include <fstream>
#include <limits>

#include <pluginlib/class_list_macros.hpp>

namespace stairwright_controller {

namespace player = stairwright::player;
using controller_interface::CallbackReturn;
using controller_interface::InterfaceConfiguration;
using controller_interface::interface_configuration_type;

namespace {

const char* const kAxes[] = {"x", "y", "z"};

// NaN where nothing can be read: the player stops at that. Newer releases have get_optional, older ones get_value.
template <class Interface>
double read(const Interface& interface) {
    if constexpr (requires { interface.get_optional(); })
        return interface.get_optional().value_or(std::numeric_limits<double>::quiet_NaN());
    else
        return interface.get_value();
}

}  // namespace

CallbackReturn PlanController::on_init() {
    auto_declare<std::string>("plan_file", "");
    auto_declare<std::string>("imu_name", "imu");
    return CallbackReturn::SUCCESS;
}

CallbackReturn PlanController::on_configure(const rclcpp_lifecycle::State&) {
    const std::string path = get_node()->get_parameter("plan_file").as_string();
    imu_ = get_node()->get_parameter("imu_name").as_string();
    try {
        std::ifstream text(path);
        file_ = player::read_plan_file(text);
        player::Player rehearsal(file_);  // refuses here what it would refuse later
    } catch (const std::exception& error) {
        RCLCPP_ERROR(get_node()->get_logger(), "plan_file '%s': %s", path.c_str(), error.what());
        return CallbackReturn::ERROR;
    }
    motors_.clear();
    for (std::size_t k = 0; k < player::kMotors; ++k)
        if (file_.motors[k].kind != player::MotorRole::Kind::none) motors_.push_back(k);
    return CallbackReturn::SUCCESS;
}

InterfaceConfiguration PlanController::command_interface_configuration() const {
    InterfaceConfiguration out{interface_configuration_type::INDIVIDUAL, {}};
    for (const std::size_t k : motors_) out.names.push_back(file_.motors[k].name + "/effort");
    return out;
}

InterfaceConfiguration PlanController::state_interface_configuration() const {
    InterfaceConfiguration out{interface_configuration_type::INDIVIDUAL, {}};
    for (const std::size_t k : motors_)
        for (const char* what : {"/position", "/velocity", "/effort"}) out.names.push_back(file_.motors[k].name + what);
    for (const char* what : {"/angular_velocity.", "/linear_acceleration."})
        for (const char* axis : kAxes) out.names.push_back(imu_ + what + axis);
    return out;
}

CallbackReturn PlanController::on_activate(const rclcpp_lifecycle::State&) {
    player_ = std::make_unique<player::Player>(file_);
    phase_ = player_->phase();
    return CallbackReturn::SUCCESS;
}

CallbackReturn PlanController::on_deactivate(const rclcpp_lifecycle::State&) {
    for (auto& interface : command_interfaces_) static_cast<void>(interface.set_value(0.0));
    player_.reset();
    return CallbackReturn::SUCCESS;
}

controller_interface::return_type PlanController::update(const rclcpp::Time& time, const rclcpp::Duration&) {
    player::LowState state;
    state.time = time.seconds();
    // Interfaces come in the order in which they were asked for.
    for (std::size_t i = 0; i < motors_.size(); ++i)
        state.motors[motors_[i]] = {read(state_interfaces_[3 * i]), read(state_interfaces_[3 * i + 1]), read(state_interfaces_[3 * i + 2])};
    const std::size_t imu = 3 * motors_.size();
    for (std::size_t i = 0; i < 3; ++i)
        state.gyro[i] = read(state_interfaces_[imu + i]), state.accelerometer[i] = read(state_interfaces_[imu + 3 + i]);
    const player::LowCommand& command = player_->step(state);
    for (std::size_t i = 0; i < motors_.size(); ++i) {
        const player::MotorCommand& c = command.motors[motors_[i]];
        const player::MotorState& own = state.motors[motors_[i]];
        const double effort = player_->phase() == player::Phase::refused ? 0.0 : c.tau + c.kp * (c.q - own.q) + c.kd * (c.dq - own.dq);
        static_cast<void>(command_interfaces_[i].set_value(std::isfinite(effort) ? effort : 0.0));
    }
    if (player_->phase() != phase_) {
        phase_ = player_->phase();
        RCLCPP_INFO(get_node()->get_logger(), "%s %s", player::name(phase_), player_->reason().c_str());
    }
    return controller_interface::return_type::OK;
}

}  // namespace stairwright_controller

PLUGINLIB_EXPORT_CLASS(stairwright_controller::PlanController, controller_interface::ControllerInterface)
