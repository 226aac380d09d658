#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "estimation/leg.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper {

enum class NominalPhase : std::uint8_t { flight, compression, extension };
template <>
struct EnumNames<NominalPhase> {
  static constexpr std::array<std::string_view, 3> value{"flight", "compression", "extension"};
};

// Nominal controller of the diagnosis. It gets the true foot height, while the firmware must detect
// touchdown from its measurements. The leg is a spring, F = K (L0 - L) - B Ldot, torque = F L' (limited by
// the drives):
//   flight       K 500, L0 0.30, B 15   until x_f <= 0 and (L0 - L > 2 mm or Ldot < -50 mm/s)
//   compression  K k_c, L0 0.30, B 0    until Ldot >= 0 and L0 - L > 4 mm
//   extension    K 500, L0 0.34, B 0    until L >= L0 - 0.5 mm, then flight
// After a liftoff below the surface a touchdown counts only after the foot has been above it. For a later
// stride the caller gives the foot's height over the surface where it will land, which is the crater's floor.
class NominalController {
 public:
  struct Input {
    double foot_z_m;
    double angle_rad;
    double angular_velocity_radps;
  };

  NominalController(const NominalControllerConfig& config, double compression_stiffness_N_per_m)
      : c_(config), compression_stiffness_N_per_m_(compression_stiffness_N_per_m) {}

  // Sum of both motors' torque, held until the next call.
  double step(const Leg& leg, const Input& in) noexcept {
    const auto kinematics = leg.kinematics(in.angle_rad);
    const double length_m = kinematics.length_m;
    const double rate_mps = kinematics.dlength_m_per_rad * in.angular_velocity_radps;
    advance_phase(in.foot_z_m, length_m, rate_mps);
    const Spring s = spring();
    const double force_N = s.stiffness_N_per_m * (s.length_m - length_m) - s.damping_N_s_per_m * rate_mps;
    return force_N * kinematics.dlength_m_per_rad;
  }

  NominalPhase phase() const noexcept { return phase_; }

 private:
  struct Spring {
    double stiffness_N_per_m, length_m, damping_N_s_per_m;
  };

  void advance_phase(double foot_z_m, double length_m, double rate_mps) noexcept {
    const double deflection_m = c_.compression_length_m - length_m;
    if (foot_z_m > 0.0) touchdown_possible_ = true;
    if (phase_ == NominalPhase::flight && touchdown_possible_ && foot_z_m <= 0.0 &&
        (deflection_m > c_.touchdown_deflection_m || rate_mps < -c_.touchdown_rate_mps)) {
      phase_ = NominalPhase::compression;
    } else if (phase_ == NominalPhase::compression && rate_mps >= 0.0 &&
               deflection_m > c_.compression_end_min_deflection_m) {
      phase_ = NominalPhase::extension;
    } else if (phase_ == NominalPhase::extension && length_m >= c_.extension_length_m - c_.liftoff_margin_m) {
      phase_ = NominalPhase::flight;
      touchdown_possible_ = false;
    }
  }

  Spring spring() const noexcept {
    switch (phase_) {
      case NominalPhase::compression:
        return {compression_stiffness_N_per_m_, c_.compression_length_m, c_.stance_damping_N_s_per_m};
      case NominalPhase::extension:
        return {c_.extension_stiffness_N_per_m, c_.extension_length_m, c_.stance_damping_N_s_per_m};
      case NominalPhase::flight:
        break;
    }
    return {c_.flight_stiffness_N_per_m, c_.compression_length_m, c_.flight_damping_N_s_per_m};
  }

  NominalControllerConfig c_;
  double compression_stiffness_N_per_m_;
  NominalPhase phase_ = NominalPhase::flight;
  bool touchdown_possible_ = true;
};

}  // namespace sandhopper
