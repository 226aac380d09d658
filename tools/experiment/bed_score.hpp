#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "terrain/ground_events.hpp"
#include "tools/experiment/bed_strides.hpp"
#include "tools/experiment/coverage_score.hpp"
#include "tools/experiment/drawn_ground.hpp"
#include "tools/experiment/place_score.hpp"

// Scores the results of strides on beds of every family: coverage and width of the strength profile, slope of
// a line, crater of later strides, and events found, missed and false.
namespace sandhopper {

// Score of a value with a 95 % interval against the true value.
struct NumberScore {
  double count = 0.0;
  double absolute_error = 0.0;  // sum of |value / truth - 1|
  double covered = 0.0;

  void add(double value, double low, double high, double truth);
};

struct FirstStrideScore {
  double strides = 0.0;
  CoverageScore band{};
  CoverageScore less_drag{}, more_drag{};  // parts of `band`: steady drag below zero, and above
  std::vector<double> width_20mm{};        // 2 x 1.96 sd / true value at 20 mm, for strides that reached it
  double line_valid = 0.0;   // strides for which a straight line is reported as a valid description
  double joint_valid = 0.0;  // the same by the joint fit
  // For beds that are a line: its slope, for strides that both call valid.
  NumberScore slope{}, joint_slope{};
  std::array<double, 6> shapes{};  // number of strides per GroundShape
};

// Score of strides 2 and 3, which land in the crater.
struct CraterScore {
  double strides = 0.0;
  NumberScore reloading{};                // for intervals with two ends
  double bounds = 0.0;                    // number of results with a lower bound only
  std::vector<double> reloading_width{};  // width of the interval over the true value
  double deeper = 0.0;                    // strides that truly went deeper, by more than the stated error of
                                          // the depth
  double curves = 0.0;                    // those of them with samples on new ground
  CoverageScore fresh{};                  // at depths that are new in this stride
  CoverageScore band{};                   // at every depth visited so far
  double landings = 0.0, landing_error_m = 0.0, landing_squared_m2 = 0.0;  // BedStride::landing_error_m
  double landing_rms_m() const { return std::sqrt(landing_squared_m2 / landings); }
};

struct EventScore {
  double possible = 0.0;  // strides in which the event happened
  double found = 0.0;     // those of them found with a depth error within 10 mm
  double within_2mm = 0.0;
  double depth_error_m = 0.0, depth_error_squared_m2 = 0.0;  // sums over those found
  double absent = 0.0;                                       // strides in which it did not happen
  double false_alarms = 0.0;                                 // those of them in which it was reported
  double largest_absent = 0.0;                               // largest statistic over threshold in these
  std::vector<double> absent_statistics{};  // T / u of each stride without the event: distribution under the
                                            // null
};

struct EventScores {
  EventScore rupture{}, boundary{}, floor{}, suction{};
};

// Mean time from the surface to the depth at contact, beyond the expected one (`ProfileSolver::contact_depth`
// with the stride's own posterior): the slope of the depth error over the speed, in first strides that are
// faster than 0.3 m/s. Zero if ProfileConfig::contact_time_s is right.
struct ContactTimeScore {
  double error_speed_m2_per_s = 0.0, speed_squared_m2_per_s2 = 0.0;  // sums over strides
  double remaining_s() const { return error_speed_m2_per_s / speed_squared_m2_per_s2; }
};

struct BedScore {
  std::string bed;
  double trials = 0.0, incomplete = 0.0;
  double contact_error_m = 0.0;                   // sum over trials
  std::vector<StrideDepthErrors> depth_errors{};  // of first strides
  ContactTimeScore contact_time{};
  FirstStrideScore first{};
  CraterScore crater{};
  EventScores first_events{}, later_events{};
  std::vector<PlacesScore> places{};          // one for each number of places that was asked for
  std::vector<double> solve_s{}, search_s{};  // for each stride: profile and summary; events
};

struct BedScoreSetup {
  CycleConfig cycle{};
  WorldConfig world{};
  std::vector<std::string> beds{};        // names of bed_cases(); empty: those that are standard
  GroundDraw ground = GroundDraw::prior;  // drawn for each trial, or for each session of several places
  long trials = 200;                      // trials per bed, of three strides each
  // Numbers of places: first strides on beds that have a common curve are also joined to sessions of so many
  // places, each on one ground.
  std::vector<int> places{};
  std::uint64_t first_seed = 1;
  unsigned threads = 2;
  std::function<void(long done, long total)> progress{};
  std::function<void(const BedScore&)> finished{};  // called after each bed
};

// Throws std::invalid_argument if a name is not in bed_cases().
std::vector<BedScore> score_beds(const BedScoreSetup& setup);

void to_json(nlohmann::ordered_json& json, const BedScore& score);

}  // namespace sandhopper
