#include "tools/diagnose/evidence/proposals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kGrowing = 24;  // Number of best sets that are extended by one more effect.

// A candidate with one choice of its shapes, and the columns of the Gram matrix that belong to it.
struct Option {
  std::size_t candidate;
  std::vector<double> values;  // Fixed shapes; for the point's own effects, the fitted values.
  std::vector<std::size_t> parameters;
  std::vector<Index> columns;
  bool own = false;
};

struct Weighed {
  std::vector<std::size_t> options;
  VectorXd size;
  double deviance = 0.0;
};

class Weigher {
 public:
  Weigher(const Problem& problem, const Point& point) : problem_(problem) {
    auto directions = parameter_directions(problem, point);
    add_own(point);
    const auto tolerances = static_cast<Index>(point.tolerances.size());
    const Index first_tolerance = static_cast<Index>(directions.size()) - tolerances + 1;
    add_others(point, directions);
    const auto linear = linearise_all(problem, point, directions);
    const auto grams = eliminated(linear, first_tolerance, tolerances, VectorXd::Ones(tolerances));
    gram_ = MatrixXd::Zero(grams.front().rows(), grams.front().cols());
    for (const auto& gram : grams) gram_ += gram;
    // Add the point's own amplitudes back to the residual, so that column 0 is the residual without its
    // effects.
    VectorXd back = VectorXd::Zero(gram_.rows());
    back[0] = 1.0;
    for (const auto& option : options_)
      if (option.own)
        for (std::size_t i = 0; i < option.columns.size(); ++i)
          if (amplitude_at(option, i)) back[option.columns[i]] = in_typicals(option, i);
    const VectorXd column = gram_ * back;
    const double corner = back.dot(column);
    gram_.col(0) = column;
    gram_.row(0) = column.transpose();
    gram_(0, 0) = corner;
  }

  const std::vector<Option>& options() const { return options_; }

  // Computes the sizes and the deviance of a set. Returns false if an amplitude is out of its bounds.
  bool weigh(Weighed& set) const {
    std::vector<Index> columns;
    std::vector<std::pair<const Option*, std::size_t>> which;
    for (const auto o : set.options)
      for (std::size_t i = 0; i < options_[o].columns.size(); ++i) {
        columns.push_back(options_[o].columns[i]);
        which.emplace_back(&options_[o], i);
      }
    const auto k = static_cast<Index>(columns.size());
    MatrixXd information(k, k);
    VectorXd score(k);
    for (Index i = 0; i < k; ++i) {
      const auto a = columns[static_cast<std::size_t>(i)];
      score[i] = gram_(a, 0);
      for (Index j = 0; j < k; ++j) information(i, j) = gram_(a, columns[static_cast<std::size_t>(j)]);
      const auto& [option, at] = which[static_cast<std::size_t>(i)];
      information(i, i) += amplitude_at(*option, at) ? kPriorOfAmplitude : 1.0;
    }
    set.size = information.ldlt().solve(score);
    set.deviance = gram_(0, 0) - score.dot(set.size);
    for (Index i = 0; i < k; ++i) {
      const auto& [option, at] = which[static_cast<std::size_t>(i)];
      if (!amplitude_at(*option, at)) continue;
      const auto& p = parameter(*option, at);
      const double value = set.size[i] * p.typical;
      if (!(value >= p.low && value <= p.high)) return false;
    }
    return std::isfinite(set.deviance);
  }

  Hypothesis start(const Weighed& set) const {
    Hypothesis h;
    Index at = 0;
    for (const auto o : set.options) {
      const Option& option = options_[o];
      auto values = option.values;
      for (std::size_t i = 0; i < option.columns.size(); ++i, ++at) {
        const auto& p = parameter(option, i);
        double& value = values[option.parameters[i]];
        value =
            std::clamp(amplitude_at(option, i) ? set.size[at] * p.typical : value + set.size[at] * p.typical,
                       p.low, p.high);
      }
      h.candidates.push_back(option.candidate);
      h.values.push_back(std::move(values));
    }
    return h;
  }

 private:
  const EffectParameter& parameter(const Option& option, std::size_t column) const {
    return problem_.candidates[option.candidate].parameters[option.parameters[column]];
  }
  bool amplitude_at(const Option& option, std::size_t column) const {
    return is_amplitude(problem_.candidates[option.candidate].parameters, option.parameters[column]);
  }
  double in_typicals(const Option& option, std::size_t column) const {
    return option.values[option.parameters[column]] / parameter(option, column).typical;
  }

  void add_own(const Point& point) {
    Index next = 1;
    for (std::size_t e = 0; e < point.hypothesis.candidates.size(); ++e) {
      Option option{point.hypothesis.candidates[e], point.hypothesis.values[e], {}, {}, true};
      for (std::size_t i = 0; i < option.values.size(); ++i) {
        option.parameters.push_back(i);
        option.columns.push_back(next++);
      }
      options_.push_back(std::move(option));
    }
  }

  void add_others(const Point& point, std::vector<Direction>& directions) {
    for (std::size_t c = 0; c < problem_.candidates.size(); ++c) {
      if (point.hypothesis.contains(c)) continue;
      const auto& parameters = problem_.candidates[c].parameters;
      for (const auto& choice : shape_choices(problem_.candidates[c])) {
        Option option{c, choice, {}, {}, false};
        for (std::size_t i = 0; i < parameters.size(); ++i) {
          if (!is_amplitude(parameters, i)) continue;
          Hypothesis with = point.hypothesis;
          auto values = choice;
          const double step = signature_step(problem_.candidates[c], choice, i);
          values[i] = step * parameters[i].typical;
          with.candidates.push_back(c);
          with.values.push_back(values);
          directions.push_back({edits_for(problem_, with, point.tolerances), step});
          option.parameters.push_back(i);
          option.columns.push_back(static_cast<Index>(directions.size()));
        }
        options_.push_back(std::move(option));
      }
    }
  }

  const Problem& problem_;
  std::vector<Option> options_;
  MatrixXd gram_;
};

}  // namespace

std::vector<Proposal> propose(const Problem& problem, const Point& point, std::size_t most_effects,
                              std::size_t count, double cost_of_an_effect) {
  const Weigher weigher(problem, point);
  const auto& options = weigher.options();
  const auto better = [](const Weighed& a, const Weighed& b) { return a.deviance < b.deviance; };
  std::vector<Weighed> all, front, exchanged;
  const std::size_t own = point.hypothesis.candidates.size();
  for (std::size_t size = 1; size <= most_effects; ++size) {
    std::vector<Weighed> grown;
    std::set<std::vector<std::size_t>> seen;
    const auto extend = [&](const std::vector<std::size_t>& from) {
      for (std::size_t o = 0; o < options.size(); ++o) {
        const bool same = std::any_of(from.begin(), from.end(), [&](std::size_t f) {
          return options[f].candidate == options[o].candidate;
        });
        if (same) continue;
        Weighed set{from, {}, 0.0};
        set.options.push_back(o);
        std::sort(set.options.begin(), set.options.end());
        if (!seen.insert(set.options).second) continue;
        if (weigher.weigh(set)) grown.push_back(std::move(set));
      }
    };
    if (size == 1) {
      extend({});
    } else if (size == 2) {
      for (std::size_t o = 0; o < options.size(); ++o) extend({o});
    } else {
      for (const auto& set : front) extend(set.options);
    }
    std::sort(grown.begin(), grown.end(), better);
    for (const auto& set : grown)
      if (size == own && std::ranges::count_if(set.options, [&](std::size_t o) { return options[o].own; }) ==
                             static_cast<std::ptrdiff_t>(own) - 1)
        exchanged.push_back(set);
    front.assign(grown.begin(),
                 grown.begin() + static_cast<std::ptrdiff_t>(std::min(grown.size(), kGrowing)));
    for (auto set : front) {
      set.deviance += cost_of_an_effect * static_cast<double>(size);
      all.push_back(std::move(set));
    }
  }
  std::sort(all.begin(), all.end(), better);
  // Keep the best choice of shapes for each set of candidates.
  std::vector<Proposal> proposals;
  std::set<std::vector<std::size_t>> told;
  const auto tell = [&](const std::vector<Weighed>& sets, std::size_t most, double cost) {
    const std::size_t before = proposals.size();
    for (const auto& set : sets) {
      if (proposals.size() == before + most) break;
      Proposal p{weigher.start(set), set.deviance + cost};
      auto key = p.start.candidates;
      std::sort(key.begin(), key.end());
      if (told.insert(key).second) proposals.push_back(std::move(p));
    }
  };
  tell(all, count, 0.0);
  tell(exchanged, count, cost_of_an_effect * static_cast<double>(own));
  return proposals;
}

}  // namespace sandhopper::diagnose
