#include "tools/diagnose/discrepancy/free_laws.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/model/sign_smooth.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr int kLawKnots = 9;  // knots of a law of free form
// Fraction of the values ignored at each end of the range.
constexpr double kTails = 0.005;
// Equally spaced knots, for variables in which a law may ripple; only if the simulation is cheap.
constexpr int kFineKnots = 41;

struct Variable {
  std::string name;
  double (*value)(const PortState&);
  double (*weight)(const PortState&);  // multiplies the law
  bool ripples = false;
  bool of_model_error = false;
};

double one(const PortState&) { return 1.0; }

const BodyState& body(const PortState& s) { return std::get<BodyState>(s); }
double height_of_body(const PortState& s) { return body(s).height_m; }
double velocity_of_body(const PortState& s) { return body(s).velocity_mps; }
double fallen_of(const PortState& s) { return body(s).start_height_m - body(s).height_m; }

const RailState& rail(const PortState& s) { return std::get<RailState>(s); }
double height_on_rail(const PortState& s) { return rail(s).height_m; }
double velocity_on_rail(const PortState& s) { return rail(s).velocity_mps; }
double direction_on_rail(const PortState& s) { return sign_smooth(rail(s).velocity_mps, 0.02); }

const AxisState& axis(const PortState& s) { return std::get<AxisState>(s); }
double angle_of(const PortState& s) { return axis(s).angle_rad; }
double rate_of_axis(const PortState& s) { return axis(s).velocity_radps; }
double since_turn_of(const PortState& s) { return std::abs(axis(s).angle_rad - axis(s).turned_rad); }
double torque_of(const PortState& s) { return axis(s).torque_Nm; }
double direction_of_axis(const PortState& s) { return sign_smooth(axis(s).velocity_radps, 0.02); }

const GroundState& ground(const PortState& s) { return std::get<GroundState>(s); }
double depth_of(const PortState& s) { return ground(s).depth_m; }
double speed_of(const PortState& s) { return ground(s).speed_mps; }
double since_touch_of(const PortState& s) { return ground(s).since_touch_s; }
double virgin(const PortState& s) { return ground(s).virgin; }
double not_virgin(const PortState& s) { return 1.0 - ground(s).virgin; }
double virgin_load(const PortState& s) { return ground(s).virgin * ground(s).quasi_static_N / 20.0; }
double virgin_speed(const PortState& s) { return ground(s).virgin * ground(s).speed_mps; }

double value_of(const PortState& s) { return std::get<SensorState>(s).value; }
double rate_of(const PortState& s) { return std::get<SensorState>(s).rate; }

std::vector<Variable> variables_of(const std::string& port, bool sensor) {
  if (sensor) return {{"value", value_of, one}, {"rate", rate_of, one}, {"t_s", time_of, one}};
  switch (law_port(port)) {
    case LawPort::ground_force:
      return {{"depth_m", depth_of, virgin, true, true},
              {"speed_mps", speed_of, virgin, false, true},
              {"speed_mps, times the quasi-static force", speed_of, virgin_load},
              {"depth_m, times speed", depth_of, virgin_speed},
              {"time since touchdown, s, times the quasi-static force", since_touch_of, virgin_load},
              {"depth_m, unloading", depth_of, not_virgin, false, true},
              {"t_s", time_of, one, true}};
    case LawPort::body:
      return {{"velocity_mps", velocity_of_body, one, false, true},
              {"height_m", height_of_body, one, true, true},
              {"distance fallen, m", fallen_of, one, true},
              {"t_s", time_of, one, true}};
    case LawPort::axis:
      return {{"velocity_radps", rate_of_axis, one, false, true},
              {"position_rad", angle_of, one, false, true},
              {"position_rad, with the sign of velocity", angle_of, direction_of_axis},
              {"angle since the last turn, rad, with the sign of velocity", since_turn_of, direction_of_axis},
              {"torque_Nm", torque_of, one},
              {"t_s", time_of, one}};
    case LawPort::joint:
      return {{"velocity_radps", rate_of_axis, one, false, true},
              {"angle_rad", angle_of, one, false, true},
              {"torque_Nm", torque_of, one}};
    case LawPort::rail:
      return {{"velocity_mps", velocity_on_rail, one, false, true},
              {"height_m", height_on_rail, one, false, true},
              {"height_m, with the sign of velocity", height_on_rail, direction_on_rail, false, true},
              {"t_s", time_of, one}};
    default:
      return {};
  }
}

// Values of a variable that the simulation visits.
struct Visited {
  std::vector<std::pair<double, double>> values;  // value, weight (1 / number of values in its trial)
};
std::vector<Visited> visited(const Problem& problem, const Point& point, const std::string& port, bool sensor,
                             const std::vector<Variable>& variables) {
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<std::vector<std::vector<double>>> trials(problem.trials.size(),
                                                       std::vector<std::vector<double>>(variables.size()));
  parallel_for(trials.size(), [&](std::size_t t) {
    const Law probe = [&](const PortState& s) {
      for (std::size_t i = 0; i < variables.size(); ++i) {
        if (variables[i].weight(s) == 0.0) continue;
        const double v = variables[i].value(s);
        if (std::isfinite(v)) trials[t][i].push_back(v);
      }
      return 0.0;
    };
    std::vector<double> out(problem.trials[t]->rows.size());
    problem.trials[t]->predict(with_term(base, {port, sensor, probe, 1.0}, 1.0), point.nuisances[t], out);
  });
  std::vector<Visited> all(variables.size());
  for (const auto& trial : trials)
    for (std::size_t i = 0; i < variables.size(); ++i)
      for (const double v : trial[i])
        all[i].values.emplace_back(v, 1.0 / static_cast<double>(trial[i].size()));
  return all;
}

std::vector<double> uniform_knots(double low, double high, int count) {
  std::vector<double> knots;
  knots.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) knots.push_back(low + (high - low) * k / (count - 1));
  return knots;
}

// Quantiles of the visited values, at least `kClosest` of the range apart.
std::vector<double> knots_by_share(Visited& visited, int count) {
  constexpr double kClosest = 2e-3;
  auto& values = visited.values;
  std::ranges::sort(values);
  double total = 0.0;
  for (const auto& [value, weight] : values) total += weight;
  const double low = values.front().first, high = values.back().first, apart = kClosest * (high - low);
  std::vector<double> knots{low};
  double sum = 0.0;
  for (const auto& [value, weight] : values) {
    sum += weight;
    const double share = static_cast<double>(knots.size()) / (count - 1);
    if (static_cast<int>(knots.size()) < count - 1 && sum >= share * total)
      knots.push_back(std::max(value, knots.back() + apart));
  }
  knots.push_back(std::max(high, knots.back() + apart));
  return knots;
}

FreeFamily family_of(const FreePort& port, const Variable& variable, std::vector<double> knots) {
  FreeFamily family{port.port,        port.sensor, variable.name,          port.scale,
                    std::move(knots), {},          variable.of_model_error};
  const auto count = family.knots.size();
  for (std::size_t k = 0; k < count; ++k) {
    const double knot = family.knots[k], scale = port.scale;
    const double below = k > 0 ? knot - family.knots[k - 1] : family.knots[1] - knot;
    const double above = k + 1 < count ? family.knots[k + 1] - knot : below;
    const auto value = variable.value;
    const auto weight = variable.weight;
    family.terms.push_back({port.port, port.sensor,
                            [=](const PortState& s) {
                              const double v = value(s) - knot,
                                           u = 1.0 - std::abs(v) / (v < 0.0 ? below : above);
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
    auto all = visited(problem, point, port.port, port.sensor, variables);
    for (std::size_t v = 0; v < variables.size(); ++v) {
      if (all[v].values.empty()) continue;
      const auto knots = knots_by_share(all[v], kLawKnots);
      const double low = all[v].values.front().first, high = all[v].values.back().first;
      if (!(high > low)) continue;
      const bool quick = !problem.plant->is_costly();
      families.push_back(family_of(port, variables[v], knots));
      if (variables[v].ripples && quick) {
        families.push_back(family_of(port, variables[v], uniform_knots(low, high, kFineKnots)));
        families.back().of_model_error = false;
      }
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
      families.push_back(family_of(port, variable, uniform_knots(at(kTails), at(1.0 - kTails), knots)));
  }
  return families;
}

Eigen::MatrixXd knot_correlation(Eigen::Index knots) {
  constexpr double kAlike = 2.0;  // correlation length, in knots
  Eigen::MatrixXd correlation(knots, knots);
  for (Eigen::Index i = 0; i < knots; ++i)
    for (Eigen::Index j = 0; j < knots; ++j)
      correlation(i, j) = std::exp(-std::abs(static_cast<double>(i - j)) / kAlike);
  return correlation;
}

Eigen::MatrixXd free_law_information(std::size_t knots) {
  return (knot_correlation(static_cast<Eigen::Index>(knots)) / kFreeLawInformation).inverse();
}

Edits with_term(Edits base, const FreeTerm& term, double amplitude) {
  const Law law = term.law;
  const Law scaled = [law, amplitude](const PortState& s) { return amplitude * law(s); };
  if (term.sensor) {
    base.sensor_law(term.port, scaled);
  } else {
    base.law(law_port(term.port), scaled);
    base.laws_key = 0;
  }
  return base;
}

}  // namespace sandhopper::diagnose
