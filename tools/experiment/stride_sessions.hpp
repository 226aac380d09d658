#pragma once
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "terrain/next_stride.hpp"
#include "tools/experiment/bed_strides.hpp"

// Sessions of single strides on one bed that is prepared alike before each, until the widest part of the
// profile's band is half of what it was after the first stride: with set-ups drawn at random, with those of
// next_stride.hpp, and with those of an oracle that has hopped every set-up on the true bed.
// Depths of interest: 5 to 50 mm, as far as any set-up reaches on the true bed. The first stride is dropped
// from the middle height with the middle stiffness. A bed is drawn from its family once a session; its grains
// differ from stride to stride.
namespace sandhopper {

enum class NextBy : std::size_t { chance, plan, oracle };
inline constexpr std::size_t kNextBy = 3;
inline constexpr int kMostStrides =
    15;  // after the first; where the band is not half by then, that many count

struct SessionScore {
  std::string bed;
  double sessions = 0.0;
  std::array<double, kNextBy> strides{};         // sum, after the first
  std::array<double, kNextBy> unfinished{};      // sessions
  double reach_squared_m2 = 0.0, planned = 0.0;  // predicted depth less the true one, of planned strides

  SessionScore& operator+=(const SessionScore& other);  // sessions of another part, or of another bed
  double mean(NextBy by) const { return strides[static_cast<std::size_t>(by)] / sessions; }
};

struct SessionSetup {
  CycleConfig cycle{};
  WorldConfig world{};
  std::vector<std::string> beds{};  // names of bed_cases(); empty: those of a family
  long sessions = 200;              // altogether, evenly over the beds
  std::uint64_t first_seed = 1;
  unsigned threads = 2;
  std::function<void(long done, long total)> progress{};
};

std::vector<SessionScore> score_sessions(const SessionSetup& setup);

// The planner's candidates: the set-ups of hop_cells().
std::vector<StrideSetup> stride_setups();

void to_json(nlohmann::ordered_json& json, const SessionScore& score);

}  // namespace sandhopper
