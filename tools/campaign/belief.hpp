#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/node.hpp"
#include "config/problem.hpp"
#include "tools/campaign/belief_effects.hpp"
#include "tools/campaign/belief_sensors.hpp"
#include "tools/campaign/finding.hpp"
#include "tools/campaign/key_spread.hpp"
#include "tools/campaign/plant_kind.hpp"
#include "tools/plant/world_config.hpp"

// Parameters of a campaign's simulation (nominal.toml): one struct per plant, every key optional. The
// equations are those of Leg and Bed, and for the simple plants those in the comments below.
namespace sandhopper {

struct HopperBelief {
  double gravity_mps2 = kGravity_mps2;
  WorldRobotConfig robot{};
  WorldMotorConfig motor{};
  NominalControllerConfig controller{};
  BedParameters terrain{};
  BeliefSensors sensors{};
  BeliefSpread spread{};
  BeliefEffects effects{};
  std::vector<KeySpread> key_spreads{}, known_to{};

  // The configuration for the simulation in tools/plant.
  WorldConfig world() const;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("gravity_mps2", self.gravity_mps2, Range{0.0, 30.0});
    visit("robot", self.robot);
    visit("motor", self.motor);
    visit("controller", self.controller);
    visit("terrain", self.terrain);
    visit("sensors", self.sensors);
    visit("spread", self.spread);
  }
};

// A foot with prescribed motion. recorded depth = depth of the foot + F / k_r, k_r: stiffness of the rig.
struct IntruderBelief {
  struct Foot {
    double radius_m = 0.040;

    template <class Self, class Visitor>
    static constexpr void fields(Self& self, Visitor&& visit) {
      visit("radius_m", self.radius_m, Range{1e-4, 2.0});
    }
  };
  struct Rig {
    std::optional<double> stiffness_N_per_m;  // empty: rigid

    template <class Self, class Visitor>
    static constexpr void fields(Self& self, Visitor&& visit) {
      visit("stiffness_N_per_m", self.stiffness_N_per_m, Range{1.0, 1e10});
    }
  };
  double gravity_mps2 = kGravity_mps2;
  Foot foot{};
  BedParameters terrain{};
  Rig rig{};
  BeliefSensors sensors{};
  BeliefSpread spread{};
  BeliefEffects effects{};
  std::vector<KeySpread> key_spreads{}, known_to{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("gravity_mps2", self.gravity_mps2, Range{0.0, 30.0});
    visit("foot", self.foot);
    visit("terrain", self.terrain);
    visit("rig", self.rig);
    visit("sensors", self.sensors);
    visit("spread", self.spread);
  }
};

// (m + C_m rho V) h'' = -m g + B rho V g - 1/2 rho A C_d |h'| h' - b h'  (+ k (surface - h) on a bed while
// moving down). By default all terms except mass and gravity are zero.
struct FallingBodyBelief {
  static constexpr double kEverywhere_m = 1e5;
  struct Bed {
    double surface_height_m = 0.0;
    double stiffness_N_per_m = 0.0;  // 0: no bed

    template <class Self, class Visitor>
    static constexpr void fields(Self& self, Visitor&& visit) {
      visit("surface_height_m", self.surface_height_m, Range{-1e5, 1e5});
      visit("stiffness_N_per_m", self.stiffness_N_per_m, Range{0.0, 1e10});
    }
  };
  struct Body {
    double mass_kg = 1.0;
    double frontal_area_m2 = 0.0;
    double volume_m3 = 0.0;

    template <class Self, class Visitor>
    static constexpr void fields(Self& self, Visitor&& visit) {
      visit("mass_kg", self.mass_kg, Range{1e-9, 1e6});
      visit("frontal_area_m2", self.frontal_area_m2, Range{0.0, 1e4});
      visit("volume_m3", self.volume_m3, Range{0.0, 1e4});
    }
  };
  struct Medium {
    double density_kg_per_m3 = 0.0;
    double drag_coefficient = 0.0;
    double linear_drag_N_s_per_m = 0.0;
    double buoyancy_factor = 0.0;
    double added_mass_factor = 0.0;
    double upward_mps = 0.0;                  // Speed at which the medium rises, m/s.
    double surface_height_m = kEverywhere_m;  // The medium lies below this height, m.

    template <class Self, class Visitor>
    static constexpr void fields(Self& self, Visitor&& visit) {
      visit("density_kg_per_m3", self.density_kg_per_m3, Range{0.0, 30000.0});
      visit("drag_coefficient", self.drag_coefficient, Range{0.0, 100.0});
      visit("linear_drag_N_s_per_m", self.linear_drag_N_s_per_m, Range{0.0, 1e6});
      visit("buoyancy_factor", self.buoyancy_factor, Range{0.0, 10.0});
      visit("added_mass_factor", self.added_mass_factor, Range{0.0, 10.0});
      visit("upward_mps", self.upward_mps, Range{-100.0, 100.0});
      visit("surface_height_m", self.surface_height_m, Range{-1e5, 1e5});
    }
  };
  double gravity_mps2 = kGravity_mps2;
  Bed bed{};
  Body body{};
  Medium medium{};
  BeliefSensors sensors = BeliefSensors::without_effect();
  BeliefSpread spread = BeliefSpread::without_effect();
  BeliefEffects effects{};
  std::vector<KeySpread> key_spreads{}, known_to{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("gravity_mps2", self.gravity_mps2, Range{0.0, 30.0});
    visit("bed", self.bed);
    visit("body", self.body);
    visit("medium", self.medium);
    visit("sensors", self.sensors);
    visit("spread", self.spread);
  }
};

// J th'' = torque - G sin th - c tanh(th' / v_s) - b th', on the output side. The recorded torque is the
// input.
struct RotaryAxisBelief {
  struct Axis {
    double inertia_kg_m2 = 1.0;      // 0: unknown; only for an axis that is locked in every trial.
    double gravity_torque_Nm = 0.0;  // G = m g l, the torque at th = pi/2. The axis hangs down at th = 0.
    double viscous_friction_Nm_s = 0.0;
    double coulomb_friction_Nm = 0.0;
    double friction_switch_speed_radps = 0.02;
    double gear_ratio = 1.0;  // not used in the simulation

    template <class Self, class Visitor>
    static constexpr void fields(Self& self, Visitor&& visit) {
      visit("inertia_kg_m2", self.inertia_kg_m2, Range{0.0, 1e6});
      visit("gravity_torque_Nm", self.gravity_torque_Nm, Range{-1e6, 1e6});
      visit("viscous_friction_Nm_s", self.viscous_friction_Nm_s, Range{0.0, 1e6});
      visit("coulomb_friction_Nm", self.coulomb_friction_Nm, Range{0.0, 1e6});
      visit("friction_switch_speed_radps", self.friction_switch_speed_radps, Range{1e-6, 100.0});
      visit("gear_ratio", self.gear_ratio, Range{1e-3, 1e4});
    }
  };
  double gravity_mps2 = kGravity_mps2;
  Axis axis{};
  BeliefSensors sensors = BeliefSensors::without_effect();
  BeliefSpread spread = BeliefSpread::without_effect();
  BeliefEffects effects{};
  std::vector<KeySpread> key_spreads{}, known_to{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("gravity_mps2", self.gravity_mps2, Range{0.0, 30.0});
    visit("axis", self.axis);
    visit("sensors", self.sensors);
    visit("spread", self.spread);
  }
};

// In the order of CampaignPlant.
using Belief = std::variant<HopperBelief, IntruderBelief, FallingBodyBelief, RotaryAxisBelief>;

// Belief of a plant without nominal.toml. For a hopper: this project's robot in its bed.
Belief default_belief(CampaignPlant plant);
// The same without effects that a nominal.toml must state explicitly: no friction of rail and joints, no
// cogging, no low-pass behind the speed that the controller reads, no clock of its own in an accelerometer,
// so that its sample is one of the row's time. The bed has only its linear stiffness: no
// intercept, added mass, drag or separate unloading line.
Belief belief_of_silence(CampaignPlant plant);
// Value of a key whose number is still to be written (`key = "?"`).
inline constexpr std::string_view kUnknownNumber = "?";
struct UnstatedNumber {
  std::string key;  // "body.mass_kg"
  std::string file;
  ConfigPosition position;
};
// Set-up keys that give a radius or an area.
inline constexpr std::array<std::string_view, 3> kDiameterKeys{"diameter_m", "foot_diameter_m",
                                                               "plate_diameter_m"};
// The finding of such a key. It makes a trial unusable that needs the number; otherwise it is a note.
Finding finding_of(const UnstatedNumber& number, bool is_needed);
// Reads nominal.toml. Throws ConfigError with place and cure of every key that is unknown, of the wrong type
// or out of range. [spread] and [known_to] also take the name of any number of the plant (key_spread.hpp). An
// unknown key in [sensors] or [spread] is only left out with a note, because recordings from elsewhere name
// what their own simulator has. A `key = "?"` is left out and listed in `unstated`.
Belief load_belief(const std::filesystem::path& file, CampaignPlant plant, std::vector<Finding>& notes,
                   std::vector<UnstatedNumber>& unstated);

// Applies a set-up value to the belief of its trial, if its key is a key of nominal.toml or one of
// kDiameterKeys. Keys of [spread] are excluded: some have the same name as a set-up key but describe the
// scatter between trials. Returns true if the key was applied. Values of the wrong type or range are added to
// `problems`.
bool override_belief(Belief& belief, const ConfigNode& setup_value, const std::string& file,
                     std::vector<ConfigProblem>& problems);

}  // namespace sandhopper
