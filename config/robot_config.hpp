#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "config/calibration_record.hpp"
#include "drivers/can/can_config.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/log/log_config.hpp"
#include "firmware/realtime.hpp"
#include "firmware/watchdog/watchdog_config.hpp"

namespace sandhopper {

// The robot's file, config/robot.toml: one table per role. The struct of each role defines its keys, units
// and ranges.
struct RobotConfig {
  LegParameters robot{};
  MotorConfigs motor = CanConfig{}.motor;  // left, right
  EstimatorConfig estimator{};
  ControllerConfig controller{};
  ArmingConfig arming{};
  StiffnessConfig stiffness{};
  LimitsConfig limits{};
  SupervisionConfig supervision{};
  RealTimeConfig real_time{};
  WatchdogConfig watchdog{};
  LogConfig log{};
  std::optional<RobotCalibrations> calibration{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("robot", self.robot);
    visit("motor", self.motor);
    visit("estimator", self.estimator);
    visit("controller", self.controller);
    visit("arming", self.arming);
    visit("stiffness", self.stiffness);
    visit("limits", self.limits);
    visit("supervision", self.supervision);
    visit("real_time", self.real_time);
    visit("watchdog", self.watchdog);
    visit("log", self.log);
    visit("calibration", self.calibration);
  }

  // Rules that span keys and roles; called by the loader (config/load.hpp).
  void check(const std::function<void(std::string_view key, const std::string& text)>& report) const;
};

// Part of the configuration that the cycle needs.
CycleConfig cycle_config(const RobotConfig& config);

}  // namespace sandhopper
