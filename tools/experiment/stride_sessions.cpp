#include "tools/experiment/stride_sessions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <random>

#include "firmware/hop_model.hpp"
#include "tools/experiment/hopped_cycles.hpp"
#include "tools/experiment/parallel.hpp"
#include "tools/plant/trial_draw.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kFirstSetup = 7;  // index of 0.7 m/s and 375 N/m in the 15 set-ups
constexpr std::uint64_t kSeedsOfASession = 1000, kForecasts = 100, kStrides = 200, kSeedsOfAnArm = 50;
constexpr std::uint64_t kOutcomes = 400;  // after those of the arms
constexpr std::array kBands{ProfileSolver::Band::whole, ProfileSolver::Band::narrowable};

struct Stride {
  ProfileSums sums{};
  double deepest_m = 0.0;
};

class Session {
 public:
  Session(const SessionSetup& setup, const BedCase& bed, std::uint64_t seed)
      : setup_(setup),
        world_(with_drop_scatter(setup.world)),
        seed_(seed),
        setups_(stride_setups()),
        robot_(hop_model_of(setup.cycle)) {
    world_.bed_family = bed.family;
    const auto drawn = TrialDraw(world_, {.seed = seed, .noise = true, .start_ns = 0}).bed();
    world_.bed_family = drawn.family();
    world_.bed_family.strength_spread_relative = world_.bed_family.depth_spread_m = 0.0;
    world_.bed_family.exponent_spread = 0.0;
    world_.terrain.stiffness_N_per_m = drawn.parameters().stiffness_N_per_m;
    world_.spread.bed_stiffness_relative = 0.0;
    first_ = hop(setups_[kFirstSetup], seed_ + 1);
    for (std::size_t i = 0; i < setups_.size(); ++i) {
      forecasts_.push_back(hop(setups_[i], seed_ + kForecasts + i));
      range_.to_m = i == 0 ? forecasts_[0].deepest_m : std::max(range_.to_m, forecasts_[i].deepest_m);
    }
    range_.to_m = std::clamp(range_.to_m, range_.from_m, DepthRange{}.to_m);
  }

  void run(NextBy by, SessionScore& score) {
    ProfileSolver solver(setup_.cycle.stiffness);
    solver.add(first_.sums, 1);
    Halving halving(*this, solver);
    std::mt19937_64 engine(seed_);
    for (int strides = 0; strides < kMostStrides && !halving.all_done(); ++strides) {
      const Stride stride = by == NextBy::outcome ? best_outcome(solver, strides)
                                                  : chosen_stride(by, solver, strides, engine, score);
      solver.add(stride.sums, ProfileSolver::kFreshGround);
      halving.count(solver);
    }
    add(by, halving.needed, halving.done[0], score);
  }

  // The set-up that needs least strides for each band.
  void run_fixed(SessionScore& score) {
    std::array<double, kBands.size()> least{kMostStrides, kMostStrides};
    bool finished = false;
    for (std::size_t i = 0; i < setups_.size(); ++i) {
      ProfileSolver solver(setup_.cycle.stiffness);
      solver.add(first_.sums, 1);
      Halving halving(*this, solver);
      const double most = std::max(least[0], least[1]);
      for (int strides = 0; strides < most && !halving.all_done(); ++strides) {
        solver.add(outcome(i, strides).sums, ProfileSolver::kFreshGround);
        halving.count(solver);
      }
      finished = finished || halving.done[0];
      for (std::size_t b = 0; b < kBands.size(); ++b)
        if (halving.done[b]) least[b] = std::min(least[b], halving.needed[b]);
    }
    add(NextBy::fixed, least, finished, score);
  }

 private:
  // Counts strides until each band is half as wide as at the beginning.
  struct Halving {
    Halving(const Session& session, const ProfileSolver& solver) : range(session.range_) {
      for (std::size_t i = 0; i < kBands.size(); ++i)
        enough_N[i] = 0.5 * widest_band_N(solver, range, kBands[i]);
    }
    bool all_done() const { return done[0] && done[1]; }
    void count(const ProfileSolver& solver) {
      for (std::size_t i = 0; i < kBands.size(); ++i) {
        needed[i] += !done[i];
        done[i] = done[i] || widest_band_N(solver, range, kBands[i]) <= enough_N[i];
      }
    }
    DepthRange range;
    std::array<double, kBands.size()> enough_N{}, needed{};
    std::array<bool, kBands.size()> done{};
  };

  // `needed`: strides for each band.
  static void add(NextBy by, const std::array<double, kBands.size()>& needed, bool finished,
                  SessionScore& score) {
    const auto arm = static_cast<std::size_t>(by);
    score.strides[arm] += needed[0];
    score.squares[arm] += needed[0] * needed[0];
    score.unfinished[arm] += !finished;
    score.narrowable[arm] += needed[1];
  }

  Stride chosen_stride(NextBy by, const ProfileSolver& solver, int strides, std::mt19937_64& engine,
                       SessionScore& score) const {
    const StrideSetup next = choose(by, solver, engine);
    const auto arm = static_cast<std::uint64_t>(by);
    const auto stride =
        hop(next, seed_ + kStrides + kSeedsOfAnArm * arm + static_cast<std::uint64_t>(strides));
    if (by == NextBy::plan) {
      const double error_m = predicted_stride(solver, robot_, next).depth_max_m - stride.deepest_m;
      score.reach_squared_m2 += error_m * error_m;
      score.planned += 1.0;
    }
    return stride;
  }

  // Stride number `number`, from 0, if it is hopped with this set-up.
  const Stride& outcome(std::size_t setup, int number) {
    const auto key = static_cast<std::size_t>(number) * setups_.size() + setup;
    outcomes_.resize(kMostStrides * setups_.size());
    auto& known = outcomes_[key];
    if (!known) known = hop(setups_[setup], seed_ + kOutcomes + key);
    return *known;
  }

  const Stride& best_outcome(const ProfileSolver& solver, int number) {
    std::size_t best = 0;
    double least_N = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < setups_.size(); ++i) {
      ProfileSolver after = solver;
      after.add(outcome(i, number).sums, ProfileSolver::kFreshGround);
      const double widest_N = widest_band_N(after, range_);
      if (widest_N >= least_N) continue;
      least_N = widest_N;
      best = i;
    }
    return outcome(best, number);
  }

  StrideSetup choose(NextBy by, const ProfileSolver& solver, std::mt19937_64& engine) const {
    if (by == NextBy::plan) return next_stride(solver, robot_, setups_).setup;
    if (by == NextBy::chance)
      return setups_[std::uniform_int_distribution<std::size_t>(0, setups_.size() - 1)(engine)];
    std::size_t best = 0;
    double least_N = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < setups_.size(); ++i) {
      ProfileSolver after = solver;
      after.add(forecasts_[i].sums, ProfileSolver::kFreshGround);
      const double widest_N = widest_band_N(after, range_);
      if (widest_N >= least_N) continue;
      least_N = widest_N;
      best = i;
    }
    return setups_[best];
  }

  Stride hop(const StrideSetup& how, std::uint64_t seed) const {
    CycleConfig cycle = setup_.cycle;
    cycle.controller.compression_stiffness_N_per_m = how.leg_stiffness_N_per_m;
    cycle.limits.strides = 1;
    HoppedCycles trial(
        cycle, world_,
        {.release_height_m = how.drop_height_m, .seed = seed, .noise = true, .robot_seed = seed_},
        kHang_cycles);
    Stride stride;
    while (trial.next()) {
      stride.deepest_m = trial.truth().max_depth_m;
      if (!trial.controller().stride_finished()) continue;
      stride.sums = trial.controller().stride_sums().profile;
      break;
    }
    return stride;
  }

  const SessionSetup& setup_;
  WorldConfig world_;
  std::uint64_t seed_;
  std::vector<StrideSetup> setups_;
  HopModel robot_;
  Stride first_{};
  std::vector<Stride> forecasts_{};
  std::vector<std::optional<Stride>> outcomes_{};
  DepthRange range_{};
};

}  // namespace

SessionScore& SessionScore::operator+=(const SessionScore& other) {
  sessions += other.sessions;
  reach_squared_m2 += other.reach_squared_m2;
  planned += other.planned;
  for (std::size_t arm = 0; arm < kNextBy; ++arm) {
    strides[arm] += other.strides[arm];
    squares[arm] += other.squares[arm];
    with_chance[arm] += other.with_chance[arm];
    unfinished[arm] += other.unfinished[arm];
    narrowable[arm] += other.narrowable[arm];
  }
  return *this;
}

SessionScore::Ratio SessionScore::fewer(NextBy by) const {
  constexpr double kNormal975 = 1.959964;
  const auto arm = static_cast<std::size_t>(by), chance = static_cast<std::size_t>(NextBy::chance);
  const double value = strides[chance] / strides[arm];
  const double residual = squares[chance] - 2.0 * value * with_chance[arm] + value * value * squares[arm];
  const double half =
      kNormal975 * std::sqrt(std::max(residual, 0.0) * sessions / (sessions - 1.0)) / strides[arm];
  return {value, value - half, value + half};
}

std::vector<StrideSetup> stride_setups() {
  std::vector<StrideSetup> setups;
  for (const auto& cell : hop_cells())
    setups.push_back({cell.release_height_m, cell.compression_stiffness_N_per_m});
  return setups;
}

std::vector<SessionScore> score_sessions(const SessionSetup& setup) {
  const auto cases = named_bed_cases(setup.beds);
  std::vector<SessionScore> scores;
  for (const auto& bed : cases) scores.push_back({.bed = bed.name});
  std::mutex adding;
  parallel_for(
      setup.sessions, setup.threads,
      [&](long i) {
        const auto number = static_cast<std::size_t>(i) % cases.size();
        Session session(setup, cases[number],
                        setup.first_seed + kSeedsOfASession * static_cast<std::uint64_t>(i));
        SessionScore own{.bed = cases[number].name, .sessions = 1.0};
        for (const auto by : {NextBy::chance, NextBy::plan, NextBy::oracle}) session.run(by, own);
        if (setup.bounds) {
          session.run(NextBy::outcome, own);
          session.run_fixed(own);
        }
        for (std::size_t arm = 0; arm < kNextBy; ++arm)
          own.with_chance[arm] = own.strides[arm] * own.strides[static_cast<std::size_t>(NextBy::chance)];
        const std::lock_guard lock(adding);
        scores[number] += own;
      },
      setup.progress);
  return scores;
}

void to_json(nlohmann::ordered_json& json, const SessionScore& s) {
  json = {{"bed", s.bed},
          {"sessions", s.sessions},
          {"strides_by_chance", s.mean(NextBy::chance)},
          {"strides_planned", s.mean(NextBy::plan)},
          {"strides_of_oracle", s.mean(NextBy::oracle)},
          {"unfinished", s.unfinished},
          {"narrowable_by_chance", s.mean_narrowable(NextBy::chance)},
          {"narrowable_planned", s.mean_narrowable(NextBy::plan)},
          {"narrowable_of_oracle", s.mean_narrowable(NextBy::oracle)},
          {"reach_rms_m", std::sqrt(s.reach_squared_m2 / std::max(1.0, s.planned))}};
  if (s.strides[static_cast<std::size_t>(NextBy::outcome)] == 0.0) return;  // without bounds
  json["strides_by_outcome"] = s.mean(NextBy::outcome);
  json["strides_fixed"] = s.mean(NextBy::fixed);
}

}  // namespace sandhopper
