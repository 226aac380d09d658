#pragma once
#include <array>
#include <cstddef>

#include "config/fields.hpp"
#include "terrain/bed_family.hpp"

// Vertical force of a granular bed on a flat round foot, from depth, speed and the deepest point so far: an
// elastic-plastic depth law with the inertial terms of a stagnant cone of grains that grows under the foot.
//
//   F_d(z) = k [z + z0 (1 - exp(-z/dz0))]              quasi-static force, z depth of the sole
//   m_a(z) = c_g rho nu pi / (3 kap) [R^3 - (R - kap z)^3],  kap = nu / tan(theta), constant beyond z = R/kap
//   On the virgin bed (z >= z_max, v > 0, down positive):
//     F = F_d + c_d dm_a/dz v^2 + lambda rho pi R^2 v^2 - s m_a a,  s = clip(v / v_switch, 0, 1), a upward
//   Elsewhere in the crater, with E = F_d(z_max) - r k (z_max - z) and c_u = 2 zeta sqrt(r k M):
//     F = E + c_u v clip(E / 5 N, 0, 1) for E > 0, otherwise 0
//   F is never below 0: dry grains cannot pull.
// A bed of another family (terrain/bed_family.hpp) has its own F_d, and a wet one pulls a foot that leaves;
// the rest is the same.
//
// Sources: Kang et al. 2018 (depth law), Aguilar & Goldman 2016 (cone), Katsuragi & Durian 2013 (steady
// drag).
namespace sandhopper {

// If `stiffness_per_area_N_per_m3` K > 0, it replaces the depth law, with `exponent` n: F_d = K A z (z / 1
// cm)^(n-1).
struct BedParameters {
  double stiffness_N_per_m = 1500.0;
  double intercept_depth_m = 0.003;         // z0
  double intercept_growth_depth_m = 0.003;  // dz0
  double bulk_density_kg_per_m3 = 1450.0;
  double added_mass_factor = 1.0;           // c_g; 0: neither added mass nor the drag that is its gradient
  double drag_factor = 1.0;                 // c_d
  double added_mass_recruitment = 2.0;      // nu
  double added_mass_band_angle_deg = 60.0;  // theta
  double steady_drag_coefficient = 0.0;     // lambda
  double unloading_stiffness_ratio = 30.0;  // r
  double unloading_damping_ratio = 0.6;     // zeta
  double added_mass_switch_speed_mps = 0.005;
  double stiffness_per_area_N_per_m3 = 0.0;
  double exponent = 1.0;
  bool rigid = false;  // the foot does not move in stance; used by the plant, not by Bed

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("stiffness_N_per_m", self.stiffness_N_per_m, Range{0.0, 1e7});
    visit("intercept_depth_m", self.intercept_depth_m, Range{0.0, 0.2});
    visit("intercept_growth_depth_m", self.intercept_growth_depth_m, Range{1e-6, 0.2});
    visit("bulk_density_kg_per_m3", self.bulk_density_kg_per_m3, Range{0.0, 20000.0});
    visit("added_mass_factor", self.added_mass_factor, Range{0.0, 20.0});
    visit("drag_factor", self.drag_factor, Range{0.0, 20.0});
    visit("added_mass_recruitment", self.added_mass_recruitment, Range{0.01, 20.0});
    visit("added_mass_band_angle_deg", self.added_mass_band_angle_deg, Range{5.0, 85.0});
    visit("steady_drag_coefficient", self.steady_drag_coefficient, Range{0.0, 20.0});
    visit("unloading_stiffness_ratio", self.unloading_stiffness_ratio, Range{1.0, 1000.0});
    visit("unloading_damping_ratio", self.unloading_damping_ratio, Range{0.0, 5.0});
    visit("added_mass_switch_speed_mps", self.added_mass_switch_speed_mps, Range{1e-6, 1.0});
    visit("stiffness_per_area_N_per_m3", self.stiffness_per_area_N_per_m3, Range{0.0, 1e10});
    visit("exponent", self.exponent, Range{0.1, 5.0});
    visit("rigid", self.rigid);
  }
};

// Variation of the bed's strength along the depth of one trial: F_d is multiplied by 1 + relative * u(z). u
// has unit variance everywhere and is interpolated between independent knots at a distance of `spacing_m`.
struct BedFluctuation {
  static constexpr std::size_t kKnots = 128;
  double relative = 0.0;
  double spacing_m = 0.002;
  std::array<double, kKnots> knots{};  // standard normal

  double factor(double depth_m) const noexcept;
};

struct BedContact {
  double depth_m;           // depth of the sole under the undisturbed surface
  double speed_mps;         // downward
  double max_depth_m;       // deepest point of the foot in this and earlier strides
  double damping_mass_kg;   // M in c_u: mass that oscillates on the unloading line; 0 for prescribed motion
  double deepest_N = -1.0;  // curve_N(max_depth_m) if it is already known, because it is constant while the
                            // foot unloads; negative: unknown
};

// The force is affine in the foot's acceleration, so that it can be solved together with the foot's equation
// of motion: F = max(least_N, force_N - added_mass_kg * a), with a the foot's acceleration upward.
struct BedReaction {
  double force_N = 0.0;
  double added_mass_kg = 0.0;
  double least_N = 0.0;  // negative if a wet bed or an extension lets grains pull

  double at_acceleration(double foot_accel_mps2) const noexcept {
    const double force = force_N - added_mass_kg * foot_accel_mps2;
    return force > least_N ? force : least_N;
  }
};

// Additional laws of a bed; see tools/diagnose.
class BedExtension {
 public:
  virtual ~BedExtension() = default;
  // Changes the quasi-static force, on the virgin curve and at the start of an unloading line.
  virtual double quasi_static_N(double curve_N, double depth_m) const = 0;
  // Multiplies the stiffness of the unloading line.
  virtual double unloading_factor() const = 0;
  // Force added while the foot is below the undisturbed surface. `bearing_N`: the bed's own force there at
  // rest; `virgin`: at new depth and moving down.
  virtual BedReaction added(const BedContact& contact, double quasi_static_N, double bearing_N,
                            bool virgin) const = 0;
};

class Bed {
 public:
  Bed(const BedParameters& parameters, double foot_radius_m, const BedFluctuation& fluctuation = {},
      const BedFamilyParameters& family = {});

  // `extension` must outlive this bed; null removes it.
  void extend(const BedExtension* extension) noexcept { extension_ = extension; }

  double quasi_static_force_N(double depth_m) const noexcept;
  double curve_N(double depth_m) const noexcept;  // quasi-static force without an extension
  double added_mass_kg(double depth_m) const noexcept;
  double added_mass_gradient_kg_per_m(double depth_m) const noexcept;
  // Force law for this contact, including an extension.
  BedReaction reaction(const BedContact& contact) const noexcept;

  // Largest slope of the curve between 0.1 mm and this depth, over steps of 0.1 mm.
  double greatest_stiffness_N_per_m(double to_depth_m) const noexcept;
  double unloading_line_N_per_m() const noexcept;
  // Largest pull of a wet bed on the foot, reached if the crater is deep enough; 0 for a dry bed.
  double greatest_suction_N() const noexcept { return family_.parameters().suction_Pa * area_m2_; }

  // Depth at which a foot that unloads slowly from `max_depth_m` loses contact: the crater's floor.
  double crater_floor_m(double max_depth_m) const noexcept;

  const BedParameters& parameters() const noexcept { return p_; }
  const BedFamilyParameters& family() const noexcept { return family_.parameters(); }
  double foot_radius_m() const noexcept { return radius_m_; }

 private:
  double plain_curve_N(double depth_m) const noexcept;  // without family and fluctuation
  double suction_N(const BedContact& contact, double above_floor_m) const noexcept;
  double stiffness_N_per_m() const noexcept;
  // Reaction at new depth, without an extension's added force. `bears_N` is the quasi-static force at the
  // depth.
  BedReaction going_deeper(const BedContact& contact, double bears_N) const noexcept;
  BedReaction unloading(const BedContact& contact) const noexcept;
  double extended_N(double curve_N, double depth_m) const noexcept;

  const BedExtension* extension_ = nullptr;
  BedParameters p_;
  BedFluctuation fluctuation_;
  BedFamilyCurve family_;
  double radius_m_;
  double area_m2_;
  double cone_slope_;                // kap
  double gradient_scale_kg_per_m3_;  // c_g rho nu pi
};

}  // namespace sandhopper
