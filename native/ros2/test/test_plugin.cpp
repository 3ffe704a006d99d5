// The plugin is found and can be made.
#include <gtest/gtest.h>

#include <controller_interface/controller_interface.hpp>
#include <pluginlib/class_loader.hpp>

TEST(Plugin, IsFoundAndMade) {
    pluginlib::ClassLoader<controller_interface::ControllerInterface> loader("controller_interface", "controller_interface::ControllerInterface");
    EXPECT_NE(loader.createSharedInstance("stairwright_controller/PlanController"), nullptr);
}
