#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "config/fields.hpp"

// Families of beds whose quasi-static force over depth is not the plain bed's line. With the plain curve
// F_p(z) = k [z + z0 (1 - exp(-z/dz0))] of terrain/bed.hpp, foot area A and foot radius R:
//
//   F(z) = s B(z) [1 + (q - 1) w(z)] + F_c(z) + N_c c A (1 - exp(-z/z_c)) + k_f max(0, z - z_f)
//
//   B   the plain curve; in the power-law family F_p(z_r) (z/z_r)^n, which equals it at z_r.
//       Bekker's pressure-sinkage law p = k z^n; n is 0.5 for clay, 0.7 for loam, 1.1 for dry sand, 1.6 for
//       snow (Wong, Theory of Ground Vehicles, table 2.3); 1.3 for plates in glass beads (Hill 2005).
//   w   the share of the deep material: 1 / (1 + exp((h - z)/b)), minus its value at the surface, for a
//       boundary at depth h; 1 - exp(-z/l) for a bed that becomes denser with depth.
//       The resistance of grains is a friction factor times overburden (Kang et al. 2018), so the factor
//       changes from s to s q. It changes over a length, because the yielding grains extend ahead of the
//       foot. A bearing failure ahead of the boundary makes F fall in a stiff layer over a soft one:
//       punch-through (Meyerhof 1974; Teh et al. 2010).
//   F_c a brittle crust, thickness t, top at z_t: shear on the rim of the plug that the foot punches out,
//       2 pi R t tau at the rupture (Meyerhof 1974). It rises linearly over the deflection d, and then decays
//       as exp(-(z - z_t - d)/l_c). Strength of dried soil crusts: 20 to 150 kPa (Richards 1953).
//   z_f the floor of the box that holds the bed, elastic with stiffness k_f.
//   c   capillary cohesion, bearing-capacity factor N_c = 6.2 of a round shallow foot (Skempton 1951),
//       mobilised over z_c (Vesic 1973: 5 to 10 % of the foot's diameter).
//
// A wet bed also holds the foot while it leaves. Let u be the height over the crater's floor (the depth at
// which the unloading line reaches zero). While the foot moves up and u < L:
//   F = -sigma A (27/4) (u/L) (1 - u/L)^2,  peak sigma A at u = L/3
// sigma is the capillary suction, 2 kPa for 0.3 mm grains (height of capillary rise about 0.2 m). L is the
// length over which air enters from the rim. The bed has no state, so it also pulls a foot that turns between
// the floor and L. It does not pull a foot that moves down.
namespace sandhopper {

enum class BedFamily : std::uint8_t {
  line,
  power_law,
  soft_over_stiff,
  stiff_over_soft,
  crust,
  compacted,
  wet,
  gradually_denser
};

template <>
struct EnumNames<BedFamily> {
  static constexpr std::array<std::string_view, 8> value{
      "line",      "power_law", "soft_over_stiff", "stiff_over_soft", "crust",
      "compacted", "wet",       "gradually_denser"};
};

// `family` selects the power law; every other effect exists if its parameter is not neutral. bed_family_of()
// gives the values of a family. The `spread` values are one standard deviation from trial to trial, relative
// for strengths.
struct BedFamilyParameters {
  BedFamily family = BedFamily::line;
  double strength_factor = 1.0;  // s
  double density_factor = 1.0;   // multiplies the bulk density of the added mass
  double unloading_stiffness_factor = 1.0;
  double exponent = 1.0;                    // n
  double reference_depth_m = 0.030;         // z_r
  double deep_strength_ratio = 1.0;         // q
  double boundary_depth_m = 0.020;          // h
  double boundary_width_m = 0.002;          // b; 10 to 90 % in 4.4 b
  double densification_depth_m = 0.0;       // l; 0: a boundary at h instead
  double crust_shear_strength_Pa = 0.0;     // tau; 0: no crust
  double crust_thickness_m = 0.003;         // t
  double crust_depth_m = 0.010;             // z_t
  double crust_deflection_m = 0.0015;       // d
  double crust_breakage_length_m = 0.0005;  // l_c
  double cohesion_Pa = 0.0;                 // c
  double cohesion_depth_m = 0.002;          // z_c
  double floor_depth_m = 0.0;               // z_f; 0: no floor
  double floor_stiffness_N_per_m = 40e3;    // k_f
  double suction_Pa = 0.0;                  // sigma
  double suction_distance_m = 0.006;        // L
  double strength_spread_relative = 0.0;    // spread of q - 1, tau, c and sigma
  double depth_spread_m = 0.0;              // spread of h, z_t and z_f
  double exponent_spread = 0.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("family", self.family);
    visit("strength_factor", self.strength_factor, Range{0.01, 100.0});
    visit("density_factor", self.density_factor, Range{0.0, 10.0});
    visit("unloading_stiffness_factor", self.unloading_stiffness_factor, Range{0.01, 100.0});
    visit("exponent", self.exponent, Range{0.1, 5.0});
    visit("reference_depth_m", self.reference_depth_m, Range{1e-3, 0.2});
    visit("deep_strength_ratio", self.deep_strength_ratio, Range{0.01, 100.0});
    visit("boundary_depth_m", self.boundary_depth_m, Range{0.0, 0.2});
    visit("boundary_width_m", self.boundary_width_m, Range{1e-4, 0.1});
    visit("densification_depth_m", self.densification_depth_m, Range{0.0, 1.0});
    visit("crust_shear_strength_Pa", self.crust_shear_strength_Pa, Range{0.0, 1e7});
    visit("crust_thickness_m", self.crust_thickness_m, Range{0.0, 0.1});
    visit("crust_depth_m", self.crust_depth_m, Range{0.0, 0.2});
    visit("crust_deflection_m", self.crust_deflection_m, Range{1e-4, 0.05});
    visit("crust_breakage_length_m", self.crust_breakage_length_m, Range{1e-4, 0.05});
    visit("cohesion_Pa", self.cohesion_Pa, Range{0.0, 1e6});
    visit("cohesion_depth_m", self.cohesion_depth_m, Range{1e-4, 0.1});
    visit("floor_depth_m", self.floor_depth_m, Range{0.0, 1.0});
    visit("floor_stiffness_N_per_m", self.floor_stiffness_N_per_m, Range{0.0, 1e7});
    visit("suction_Pa", self.suction_Pa, Range{0.0, 1e5});
    visit("suction_distance_m", self.suction_distance_m, Range{1e-4, 0.1});
    visit("strength_spread_relative", self.strength_spread_relative, Range{0.0, 0.3});
    visit("depth_spread_m", self.depth_spread_m, Range{0.0, 0.05});
    visit("exponent_spread", self.exponent_spread, Range{0.0, 0.5});
  }

  // Depth at which the crust breaks under a slow foot. Meaningful only if the crust has a strength.
  double rupture_depth_m() const noexcept { return crust_depth_m + crust_deflection_m; }
};

// Values of a family, for the default bed of 1500 N/m under an 80 mm foot. Loose glass beads of 0.3 mm have
// 1000 to 2400 N/m, compacted ones 3600.
BedFamilyParameters bed_family_of(BedFamily family) noexcept;

// Force curve of one bed. `plain_reference_N` is the plain curve at reference_depth_m.
class BedFamilyCurve {
 public:
  BedFamilyCurve() = default;
  BedFamilyCurve(const BedFamilyParameters& parameters, double foot_radius_m, double plain_reference_N);

  // True if nothing differs from the plain bed.
  bool plain() const noexcept { return plain_; }
  const BedFamilyParameters& parameters() const noexcept { return p_; }

  // F(z) [N] for z > 0, from the plain curve's value at z.
  double force_N(double plain_N, double depth_m) const noexcept;
  // Pull of a wet bed [N, >= 0] at this height over the crater's floor, for a foot that moves up.
  double suction_N(double above_floor_m, double floor_m) const noexcept;
  // The crust's part of force_N.
  double crust_N(double depth_m) const noexcept;

 private:
  double deep_share(double depth_m) const noexcept;

  BedFamilyParameters p_{};
  bool plain_ = true;
  double area_m2_ = 0.0;
  double rupture_N_ = 0.0;
  double plain_reference_N_ = 0.0;
};

}  // namespace sandhopper
