#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

using Set = std::vector<std::size_t>;

// Standard error in typical sizes above which the recordings do not bound the effect.
constexpr double kUnbounded = 1e6;
// Size in typical sizes below which an effect lies by its prior alone, with 97.5 %. A larger bound says
// nothing about the recordings.
const double kByPriorAlone = std::exp(normal_quantile(kLevel) * kLimits.size_spread);
constexpr int kPasses = 6;  // of doubling a bound: sizes up to 32 times it are tried

// All fitted subsets of the set, including itself and the empty set.
std::vector<Set> fitted_parts(const Search& search, const Set& set) {
  std::vector<Set> parts;
  for (const auto& [tried, fit] : search.sets())
    if (std::includes(set.begin(), set.end(), tried.begin(), tried.end())) parts.push_back(tried);
  return parts;
}

// Largest size of a screened effect, in typical sizes: |size| + t s with
//   s^2 = se^2 + v / sum I,   v: deviance along any parameter that another form of the found laws leaves
struct Margin {
  double risk = 0.0;  // that the effect is larger
  double form = 0.0;  // v
  double largest(const TrialEvidence& evidence) const {
    const double information = evidence.total_information();
    if (information <= 0.0) return 1e300;
    const auto scatter = evidence.scatter();
    return std::abs(evidence.size()) + student_t_quantile(risk, scatter.degrees_of_freedom) *
                                           std::sqrt((scatter.ratio + form) / information);
  }
};

// The margin beside a set. All bounds of an answer hold together with 95 % (Bonferroni).
Margin margin_beside(const Problem& problem, const Search& search, const SetFit& set) {
  return {kLevel / static_cast<double>(problem.candidates.size()),
          form_deviance(problem, search.null().fit.deviance - set.fit.deviance)};
}

// Bound of each effect's size, in typical sizes: the largest of all cases in which the effect stands
// beside the found ones or replaces some of them. A found name may be wrong; then the true effect may have
// its full size.
std::map<std::size_t, double> largest_sizes(const Problem& problem, Search& search) {
  std::map<std::size_t, double> largest;
  const auto consider = [&](std::size_t candidate, double typicals) {
    auto& size = largest[candidate];
    size = std::max(size, typicals);
  };
  const auto parts = fitted_parts(search, search.best().set);
  for (const auto& part : parts) {
    const Margin margin = margin_beside(problem, search, search.sets().at(part));
    for (const auto& s : search.screened(part)) consider(s.candidate, margin.largest(s.evidence));
  }
  // If an effect is not linear, the fitted size may exceed the linear bound.
  for (const auto& [set, tried] : search.sets())
    for (std::size_t i = 0; i < tried.fit.point.hypothesis.candidates.size(); ++i) {
      const auto candidate = tried.fit.point.hypothesis.candidates[i];
      Set others = set;
      std::erase(others, candidate);
      if (std::ranges::find(parts, others) == parts.end()) continue;
      const auto& p = problem.candidates[candidate].parameters[0];
      consider(candidate, std::abs(tried.fit.point.hypothesis.values[i][0]) / p.typical);
    }
  return largest;
}

// An effect that is not linear, friction for example, changes the recordings otherwise at its bound than its
// derivative says. So the secants from 0 to sizes x above the bound b are tried, too. A size is possible if
//   x <= |size(x)| + t s(x),   size(x), s(x): estimate and standard deviation with the secant as the
//   signature
// and then b becomes the right side. Both signs, beside the best set. x starts at b and doubles in each pass.
// A bound that still grows in the last pass is taken out.
void enlarge_to_secants(const Problem& problem, const Search& search, std::map<std::size_t, double>& bounds) {
  const SetFit& best = search.best();
  const Margin margin = margin_beside(problem, search, best);
  const auto screen_secants = [&](const std::map<std::size_t, double>& sizes) {
    return screen(problem, best.fit.point, search.columns_for(best.set),
                  signatures_at(problem, best.fit.point, {.laws = false, .sizes = &sizes}));
  };
  std::map<std::size_t, double> tried;
  for (const auto& [candidate, bound] : bounds)
    if (bound < kUnbounded && !best.fit.point.hypothesis.contains(candidate)) tried[candidate] = bound;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::map<std::size_t, double> above, below, room;
    for (const auto& [candidate, x] : tried) {
      const auto& p = problem.candidates[candidate].parameters[0];
      if (x < p.high / p.typical) above[candidate] = x;
      if (-x > p.low / p.typical) below[candidate] = -x;
    }
    for (const auto* sizes : {&above, &below})
      for (const auto& s : screen_secants(*sizes))
        room[s.candidate] = std::max(room[s.candidate], margin.largest(s.evidence));
    for (const auto& [candidate, size] : room) {
      const double x = tried[candidate];
      tried[candidate] = 2.0 * x;
      if (size < x) continue;
      tried[candidate] = 2.0 * size;
      if (pass + 1 == kPasses)
        bounds.erase(candidate);
      else
        bounds[candidate] = std::max(bounds[candidate], size);
    }
  }
}

// Delay of a channel by its tolerances at a point, s: of its sampling instant, and half the window over which
// it is averaged.
double delay_of_tolerances_s(const Problem& problem, const Point& point, const std::string& channel) {
  double delay_s = 0.0;
  for (std::size_t i = 0; i < problem.tolerances.size(); ++i) {
    const Tolerance& tolerance = problem.tolerances[i];
    if (tolerance.channel != channel) continue;
    delay_s +=
        point.tolerances[i] * tolerance.scale * (tolerance.window_s > 0.0 ? 0.5 * tolerance.window_s : 1.0);
  }
  return std::abs(delay_s);
}

// Delays and lags, s, that the candidate with its typical size adds to each channel.
std::map<std::string, double> delays_of(const Problem& problem, const Candidate& candidate) {
  auto values = shape_choices(candidate).front();
  values[0] = candidate.parameters[0].typical;
  Edits edits;
  candidate.effect->apply(problem.context, candidate.channel, values, edits);
  std::map<std::string, double> delays_s;
  for (const SensorEdit& edit : edits.sensors)
    if (edit.kind == SensorEdit::Kind::delay_s || edit.kind == SensorEdit::Kind::lag_s)
      delays_s[edit.channel] += edit.value;
  return delays_s;
}

// A delay or a lag of a channel may be there in place of the channel's tolerances, which then fit as well.
// Adds their delay to the bounds of such effects.
void add_tolerances(const Problem& problem, const Point& point, std::map<std::size_t, double>& bounds) {
  for (auto& [index, typicals] : bounds) {
    for (const auto& [channel, delay_s] : delays_of(problem, problem.candidates[index]))
      if (delay_s != 0.0) typicals += delay_of_tolerances_s(problem, point, channel) / std::abs(delay_s);
  }
}

// True if both delay the same channel. A bound of one then contradicts the size found for the other.
bool delay_alike(const Problem& problem, const Candidate& candidate, const FoundEffect& found) {
  const auto delays = delays_of(problem, candidate);
  return !delays.empty() && std::ranges::any_of(problem.candidates, [&](const Candidate& other) {
    return other.effect->id == found.id && other.channel == found.channel &&
           std::ranges::any_of(delays_of(problem, other),
                               [&](const auto& delay) { return delays.contains(delay.first); });
  });
}

// True if the candidate may be present: it may replace a found effect, or an unknown effect may hide it (in
// the plant, or at the same sensor).
bool may_be_there(const Problem& problem, const Diagnosis& diagnosis, const Candidate& candidate) {
  return std::ranges::any_of(diagnosis.effects, [&](const FoundEffect& found) {
    if (found.is_unknown())
      return problem.context.has(found.port) ? candidate.channel == found.port : candidate.channel.empty();
    return delay_alike(problem, candidate, found) ||
           std::ranges::any_of(found.indistinguishable_from,
                               [&](const auto& id) { return id == candidate.effect->id; });
  });
}

// The bound as reported: |base + scale value| <= |base| + |scale| x. A number that the belief holds is
// bounded by its change, a stiffness or a limit (power -1) from below. None for a limit that is read off the
// data, because no size of it was fitted, and none for a size beyond the effect's range.
std::optional<Bound> bound_of(const Candidate& candidate, double typicals) {
  const auto& p = candidate.parameters[0];
  if (p.scale == 0.0 || typicals * p.typical > std::max(std::abs(p.low), std::abs(p.high)))
    return std::nullopt;
  const double size = typicals * p.typical * std::abs(p.scale);
  if (p.power == 1.0)
    return Bound{candidate.label(), p.base == 0.0 ? p.name : change_of(p.name), size, typicals};
  return Bound{candidate.label(), p.name, std::pow(std::abs(p.base) + size, p.power), typicals,
               p.power < 0.0};
}

}  // namespace

void report_absent(const Problem& problem, Search& search, Diagnosis& diagnosis) {
  auto bounds = largest_sizes(problem, search);
  enlarge_to_secants(problem, search, bounds);
  add_tolerances(problem, search.best().fit.point, bounds);
  for (const auto& [index, typicals] : bounds) {
    const auto& candidate = problem.candidates[index];
    if (search.best().fit.point.hypothesis.contains(index) || !(typicals < kByPriorAlone) ||
        may_be_there(problem, diagnosis, candidate))
      continue;
    if (const auto bound = bound_of(candidate, typicals)) diagnosis.absent.push_back(*bound);
  }
  std::sort(diagnosis.absent.begin(), diagnosis.absent.end(),
            [](const Bound& a, const Bound& b) { return a.typicals > b.typicals; });
}

}  // namespace sandhopper::diagnose
