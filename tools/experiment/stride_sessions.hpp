#pragma once
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "terrain/next_stride.hpp"
#include "tools/experiment/bed_strides.hpp"

// Sessions of single strides on one bed, which is prepared alike before each stride. A session ends when the
// widest part of the profile's band is half of its width after the first stride. Set-ups are compared that
// are drawn at random, planned by next_stride.hpp, or chosen by an oracle that has tried every set-up on the
// true bed. Two bounds, if asked for, choose with knowledge of the outcome: the stride of those to come, one
// for each set-up, that leaves the narrowest band; and the one set-up that, repeated, ends this session
// first. No plan can know either. Depths of interest are 5 to 50 mm, limited to the largest depth that any
// set-up reaches on the true bed. The first stride is dropped from the middle height with the middle
// stiffness. A bed is drawn from its family once per session; its grains differ from stride to stride.
namespace sandhopper {

enum class NextBy : std::size_t { chance, plan, oracle, outcome, fixed };
inline constexpr std::size_t kNextBy = 5;
inline constexpr int kMostStrides =
    15;  // after the first; a session whose band is not halved by then counts as this many

struct SessionScore {
  std::string bed;
  double sessions = 0.0;
  std::array<double, kNextBy> strides{};         // sum over sessions, without the first stride
  std::array<double, kNextBy> squares{};         // sum of their squares
  std::array<double, kNextBy> with_chance{};     // sum of their products with the strides by chance
  std::array<double, kNextBy> unfinished{};      // number of sessions whose band was never halved
  std::array<double, kNextBy> narrowable{};      // sum of strides until the narrowable part was halved
                                                 // (ProfileSolver::Band)
  double reach_squared_m2 = 0.0, planned = 0.0;  // for planned strides: predicted depth minus true depth

  SessionScore& operator+=(const SessionScore& other);  // adds the sessions of another part or another bed
  double mean(NextBy by) const { return strides[static_cast<std::size_t>(by)] / sessions; }
  double mean_narrowable(NextBy by) const { return narrowable[static_cast<std::size_t>(by)] / sessions; }
  struct Ratio {
    double value, ci95_low, ci95_high;
  };
  // Mean number of strides by chance over that of `by`, with the interval of a ratio of means whose unit is
  // the session (Cochran, Sampling Techniques, section 6.4).
  Ratio fewer(NextBy by) const;
};

struct SessionSetup {
  CycleConfig cycle{};
  WorldConfig world{};
  std::vector<std::string> beds{};  // names of bed_cases(); empty: those that are standard
  long sessions = 200;              // total number, distributed evenly over the beds
  std::uint64_t first_seed = 1;
  unsigned threads = 2;
  bool bounds = false;  // also by outcome and fixed: about four times as many strides
  std::function<void(long done, long total)> progress{};
};

std::vector<SessionScore> score_sessions(const SessionSetup& setup);

// Candidates of the planner: the set-ups of hop_cells().
std::vector<StrideSetup> stride_setups();

void to_json(nlohmann::ordered_json& json, const SessionScore& score);

}  // namespace sandhopper
