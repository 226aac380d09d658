#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sandhopper::diagnose {

// A place of a plant at which an effect acts, as answers name it.
enum class Port : std::uint8_t {
  body,
  rail,
  axis,
  joint,
  ground,
  inertia,
  geometry,
  actuator,
  controller,
  clock,
  sensor
};
inline constexpr std::array<std::string_view, 11> kPortNames{"body",       "rail",    "axis",     "joint",
                                                             "ground",     "inertia", "geometry", "actuator",
                                                             "controller", "clock",   "sensor"};
constexpr std::string_view name_of(Port port) { return kPortNames[static_cast<std::size_t>(port)]; }

// A place in a simulation at which a law is added. Each shows one kind of state (model/states.hpp).
enum class LawPort : std::uint8_t {
  body,              // BodyState; force, N
  body_added_mass,   // BodyState; added mass of the medium, kg
  rail,              // RailState; force, N
  axis,              // AxisState; torque, N m
  joint,             // AxisState; torque on the links, both sides together, N m
  ground_factor,     // GroundState; the depth law is multiplied by 1 + law
  ground_static,     // GroundState; added to the depth law, also where unloading begins, N
  ground_unloading,  // GroundState; the unloading line's stiffness is multiplied by 1 + law
  ground_force,      // GroundState; added to the force everywhere below the surface, N
  ground_mass,       // GroundState; added mass, kg
  ground_tension,    // GroundState; largest pull (negative force) of the bed, N
  ground_surface,    // GroundState; added to the depth, m
  foot_size,         // FootState; logarithm of a factor on the depth law
  load_cell,         // CellState; added to the force on the cell, N
  actuator_limit     // DriveState; largest torque of both motors together, N m
};
inline constexpr std::array<std::string_view, 15> kLawPortNames{
    "body",          "body.added_mass",  "rail",          "axis",        "joint",          "ground.factor",
    "ground.static", "ground.unloading", "ground.force",  "ground.mass", "ground.tension", "ground.surface",
    "foot.size",     "load_cell",        "actuator.limit"};
constexpr std::string_view name_of(LawPort port) { return kLawPortNames[static_cast<std::size_t>(port)]; }

// Throws std::invalid_argument for a name that no port has.
inline LawPort law_port(std::string_view name) {
  for (std::size_t i = 0; i < kLawPortNames.size(); ++i)
    if (kLawPortNames[i] == name) return static_cast<LawPort>(i);
  throw std::invalid_argument("diagnose: no law acts at " + std::string(name));
}

}  // namespace sandhopper::diagnose
