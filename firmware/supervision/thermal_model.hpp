#pragma once
#include "firmware/supervision/supervision_config.hpp"

namespace sandhopper {

// Winding and housing of one motor as two heat capacities:
//   C_w dT_w/dt = 1.5 R i^2 - (T_w - T_h) / R_wh,   C_h dT_h/dt = (T_w - T_h) / R_wh - (T_h - T_a) / R_ha
// with the q-axis current i [A] (amplitude-invariant, so 1.5 R i^2 in three phases of resistance R).
// Temperatures [deg C] start at ambient or at the given values. A drive's reported temperature is that of its
// board, not of the winding. Explicit Euler: the step must be far below R_wh C_w (40 s with the shipped
// constants).
class ThermalModel {
 public:
  explicit ThermalModel(const SupervisionConfig& config) noexcept
      : ThermalModel(config, config.ambient_C, config.ambient_C) {}
  ThermalModel(const SupervisionConfig& config, double winding_C, double housing_C) noexcept
      : config_(&config), winding_C_(winding_C), housing_C_(housing_C) {}

  // Advances the model by dt_s with this q-axis current.
  void step(double current_A, double dt_s) noexcept {
    const double across_W = (winding_C_ - housing_C_) / config_->winding_resistance_K_per_W;
    const double out_W = (housing_C_ - config_->ambient_C) / config_->housing_resistance_K_per_W;
    const double loss_W = 1.5 * config_->phase_resistance_Ohm * current_A * current_A;
    winding_C_ += dt_s * (loss_W - across_W) / config_->winding_capacity_J_per_K;
    housing_C_ += dt_s * (across_W - out_W) / config_->housing_capacity_J_per_K;
  }
  double winding_C() const noexcept { return winding_C_; }
  double housing_C() const noexcept { return housing_C_; }

 private:
  const SupervisionConfig* config_;
  double winding_C_;
  double housing_C_;
};

}  // namespace sandhopper
