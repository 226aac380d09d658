#include "tools/diagnose/free_laws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

namespace sandhopper::diagnose {
namespace {

constexpr int kKnots = 9;
constexpr double kTails = 0.005;
constexpr int kFineKnots = 41;  // of what may ripple, where a simulation costs little

struct Variable {
  std::string name;
  double (*value)(const PortState&);
  double (*weight)(const PortState&);  // multiplies the law
  bool ripples = false;
};

double one(const PortState&) { return 1.0; }
double time_of(const PortState& s) { return s.time_s; }
double position_of(const PortState& s) { return s.position; }
double velocity_of(const PortState& s) { return s.velocity; }
double fallen_of(const PortState& s) { return s.extreme - s.position; }
double load_of(const PortState& s) { return s.load; }
double direction_of(const PortState& s) { return std::tanh(s.velocity / 0.02); }
double virgin(const PortState& s) { return s.accel; }
double not_virgin(const PortState& s) { return 1.0 - s.accel; }
double virgin_load(const PortState& s) { return s.accel * s.load / 20.0; }
double virgin_speed(const PortState& s) { return s.accel * s.velocity; }

std::vector<Variable> variables_of(const std::string& port, bool sensor) {
  if (sensor) return {{"value", position_of, one}, {"rate", velocity_of, one}, {"t_s", time_of, one}};
  if (port == "ground.force")
    return {{"depth_m", position_of, virgin, true},
            {"speed_mps", velocity_of, virgin},
            {"speed_mps, times the quasi-static force", velocity_of, virgin_load},
            {"depth_m, times speed", position_of, virgin_speed},
            {"depth_m, unloading", position_of, not_virgin},
            {"t_s", time_of, one, true}};
  if (port == "body")
    return {{"velocity_mps", velocity_of, one},
            {"height_m", position_of, one, true},
            {"distance fallen, m", fallen_of, one, true},
            {"t_s", time_of, one, true}};
  if (port == "axis")
    return {{"velocity_radps", velocity_of, one},
            {"position_rad", position_of, one},
            {"position_rad, with the sign of velocity", position_of, direction_of},
            {"torque_Nm", load_of, one},
            {"t_s", time_of, one}};
  if (port == "joint")
    return {
        {"velocity_radps", velocity_of, one}, {"angle_rad", position_of, one}, {"torque_Nm", load_of, one}};
  return {{"velocity_mps", velocity_of, one},
          {"height_m", position_of, one},
          {"height_m, with the sign of velocity", position_of, direction_of},
          {"t_s", time_of, one}};
}

// Lowest and highest value of each variable that the simulation visits.
std::vector<std::pair<double, double>> visited(const Problem& problem, const Point& point,
                                               const std::string& port, bool sensor,
                                               const std::vector<Variable>& variables) {
  std::vector<std::pair<double, double>> ranges(
      variables.size(), {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
  Edits edits = edits_for(problem, point.hypothesis, point.tolerances);
  const Law probe = [&](const PortState& s) {
    for (std::size_t i = 0; i < variables.size(); ++i) {
      if (variables[i].weight(s) == 0.0) continue;
      const double v = variables[i].value(s);
      if (!std::isfinite(v)) continue;
      ranges[i].first = std::min(ranges[i].first, v);
      ranges[i].second = std::max(ranges[i].second, v);
    }
    return 0.0;
  };
  if (sensor)
    edits.sensor_law(port, probe);
  else
    edits.law(port, probe);
  edits.laws_key = 0;
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    std::vector<double> out(problem.trials[t]->rows.size());
    problem.trials[t]->predict(edits, point.nuisances[t], out);
  }
  return ranges;
}

FreeFamily family_of(const FreePort& port, const Variable& variable, double low, double high, int knots) {
  FreeFamily family{port.port, port.sensor, variable.name, port.scale, low, high, {}};
  const double spacing = (high - low) / (knots - 1);
  for (int k = 0; k < knots; ++k) {
    const double knot = low + spacing * k, scale = port.scale;
    const auto value = variable.value;
    const auto weight = variable.weight;
    family.terms.push_back({port.port, port.sensor,
                            [=](const PortState& s) {
                              const double u = 1.0 - std::abs(value(s) - knot) / spacing;
                              return u > 0.0 ? scale * u * weight(s) : 0.0;
                            },
                            scale});
  }
  return family;
}

}  // namespace

std::vector<FreeFamily> free_families(const Problem& problem, const Point& point) {
  auto ports = problem.plant->free_ports(problem.context);
  for (const auto& channel : problem.channels)
    if (const auto it = problem.context.channels.find(channel); it != problem.context.channels.end())
      ports.push_back({channel, true, 0.05 * (it->second.high - it->second.low)});
  std::vector<FreeFamily> families;
  for (const auto& port : ports) {
    const auto variables = variables_of(port.port, port.sensor);
    const auto ranges = visited(problem, point, port.port, port.sensor, variables);
    for (std::size_t v = 0; v < variables.size(); ++v) {
      const auto [low, high] = ranges[v];
      if (!(high > low)) continue;
      const bool quick = problem.context.plant != PlantKind::hopper;
      families.push_back(family_of(port, variables[v], low, high, kKnots));
      if (variables[v].ripples && quick)
        families.push_back(family_of(port, variables[v], low, high, kFineKnots));
    }
  }
  return families;
}

std::vector<FreeFamily> free_families_over(const FreePort& port, const std::vector<PortState>& states,
                                           int knots) {
  std::vector<FreeFamily> families;
  for (const auto& variable : variables_of(port.port, port.sensor)) {
    std::vector<double> values;
    for (const auto& s : states)
      if (variable.weight(s) != 0.0) values.push_back(variable.value(s));
    if (values.empty()) continue;
    std::ranges::sort(values);
    const auto at = [&](double share) {
      return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    if (at(1.0 - kTails) > at(kTails))
      families.push_back(family_of(port, variable, at(kTails), at(1.0 - kTails), knots));
  }
  return families;
}

Edits with_term(Edits base, const FreeTerm& term, double amplitude) {
  const Law law = term.law;
  const Law scaled = [law, amplitude](const PortState& s) { return amplitude * law(s); };
  if (term.sensor)
    base.sensor_law(term.port, scaled);
  else
    base.law(term.port, scaled);
  base.laws_key = 0;
  return base;
}

}  // namespace sandhopper::diagnose
