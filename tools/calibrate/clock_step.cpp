#include "tools/calibrate/clock_step.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "terrain/trial_statistics.hpp"
#include "tools/calibrate/line.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kSameTap_s = 0.01;
constexpr std::size_t kFewestOffsets = 6;

// Pairs of foreign taps and ours that agree if `offset_s` is added to the foreign time.
struct Match {
  double offset_s = 0.0;
  std::vector<double> ours, theirs;
};

Match match_at(double offset_s, const std::vector<double>& taps, const std::vector<double>& foreign) {
  Match out{offset_s, {}, {}};
  for (const double there : foreign) {
    const auto here = std::ranges::lower_bound(taps, there + offset_s - kSameTap_s);
    if (here == taps.end() || *here > there + offset_s + kSameTap_s) continue;
    out.ours.push_back(*here);
    out.theirs.push_back(there);
  }
  return out;
}

// All offsets that match at least two taps, those with most matches first.
std::vector<Match> matches(const std::vector<double>& taps, const std::vector<double>& foreign) {
  std::vector<Match> out;
  for (const double here : taps)
    for (const double there : foreign)
      if (auto match = match_at(here - there, taps, foreign); match.theirs.size() >= 2)
        out.push_back(std::move(match));
  std::ranges::stable_sort(out, std::ranges::greater{}, [](const Match& m) { return m.theirs.size(); });
  return out;
}

std::vector<double> without(const std::vector<double>& all, const std::vector<double>& some) {
  std::vector<double> out;
  for (const double value : all)
    if (std::ranges::find(some, value) == some.end()) out.push_back(value);
  return out;
}

// Even taps lie on a line whatever their interval is.
bool is_even(std::span<const double> taps_s) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < taps_s.size(); ++i) numbers.push_back(static_cast<double>(i));
  return fit_line(numbers, taps_s, 0.0).largest_residual < kSameTap_s;
}

}  // namespace

// Taps at even intervals match at many offsets. The pair of offsets that explains most taps is chosen.
std::optional<ClockStep> step_between_taps(const std::vector<double>& taps_s,
                                           const std::vector<double>& foreign_s) {
  const auto candidates = matches(taps_s, foreign_s);
  if (candidates.empty() || candidates.front().theirs.size() == std::min(taps_s.size(), foreign_s.size()))
    return std::nullopt;
  std::optional<ClockStep> best;
  std::size_t most = candidates.front().theirs.size();
  for (const auto& first : candidates) {
    if (2 * first.theirs.size() < most) break;
    const auto others = matches(without(taps_s, first.ours), without(foreign_s, first.theirs));
    if (others.empty()) continue;
    const auto& second = others.front();
    const auto& early = first.theirs.front() < second.theirs.front() ? first : second;
    const auto& late = &early == &first ? second : first;
    const bool in_turn = early.ours.back() < late.ours.front() && early.theirs.back() < late.theirs.front();
    const auto explained = first.theirs.size() + second.theirs.size();
    if (!in_turn || explained <= most) continue;
    most = explained;
    best = ClockStep{early.offset_s - late.offset_s, early.theirs.back(), late.theirs.front()};
  }
  return best;
}

std::optional<ClockStep> step_in_offsets(std::span<const double> foreign_s, std::span<const double> offset_s,
                                         double least_s) {
  const auto n = foreign_s.size();
  if (n < kFewestOffsets) return std::nullopt;
  std::optional<ClockStep> best;
  double largest = 1.0;  // largest |s| / ci95 so far
  for (std::size_t split = 2; split + 2 <= n; ++split) {
    Eigen::MatrixXd model(n, 3);
    for (std::size_t i = 0; i < n; ++i)
      model.row(static_cast<Eigen::Index>(i)) << 1.0, foreign_s[i] - foreign_s[0], i < split ? 0.0 : 1.0;
    const Eigen::VectorXd y =
        Eigen::Map<const Eigen::VectorXd>(offset_s.data(), static_cast<Eigen::Index>(n));
    const Eigen::Vector3d fit = model.colPivHouseholderQr().solve(y);
    const double variance = (y - model * fit).squaredNorm() / static_cast<double>(n - 3);
    const Eigen::Matrix3d covariance = variance * (model.transpose() * model).inverse();
    const double ci95 = student_t95(n - 3) * std::sqrt(covariance(2, 2));
    if (std::abs(fit(2)) < least_s || std::abs(fit(2)) <= largest * ci95) continue;
    largest = ci95 > 0.0 ? std::abs(fit(2)) / ci95 : largest;
    best = ClockStep{-fit(2), foreign_s[split - 1], foreign_s[split]};
  }
  return best;
}

std::optional<ClockDrift> drift_between_taps(const std::vector<double>& taps_s,
                                             const std::vector<double>& foreign_s, double least_s) {
  constexpr std::size_t kFewestTaps = 5;
  std::optional<ClockDrift> best;
  const auto most = std::min(taps_s.size(), foreign_s.size());
  if (most < kFewestTaps) return std::nullopt;
  // The shorter list is a part of the longer one, or both overlap.
  for (std::size_t ours = 0; ours < taps_s.size(); ++ours)
    for (std::size_t theirs = 0; theirs < foreign_s.size(); ++theirs) {
      if (ours > 0 && theirs > 0) continue;
      const auto count = std::min(taps_s.size() - ours, foreign_s.size() - theirs);
      if (count < kFewestTaps || 2 * count <= most) continue;
      const std::span there(foreign_s.data() + theirs, count);
      std::vector<double> offsets;
      for (std::size_t i = 0; i < count; ++i) offsets.push_back(taps_s[ours + i] - there[i]);
      const auto line = fit_line(there, offsets, 0.0);
      const double apart_s = std::abs(line.slope) * (there.back() - there.front());
      if (line.largest_residual >= kSameTap_s || std::abs(line.slope) <= line.slope_ci95) continue;
      if (apart_s <= kSameTap_s || step_in_offsets(there, offsets, least_s)) continue;
      if (is_even(there) && apart_s > kSameTap_s * static_cast<double>(count - 1)) continue;
      if (best && best->residual_s <= line.largest_residual) continue;
      best = ClockDrift{1.0 / (1.0 + line.slope) - 1.0, line.largest_residual, count};
    }
  return best;
}

}  // namespace sandhopper::calibrate
