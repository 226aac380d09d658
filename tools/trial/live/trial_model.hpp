#pragma once
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/node.hpp"
#include "firmware/controller_config.hpp"
#include "firmware/live_status.hpp"

namespace sandhopper {

// Result of a stride for the operator; NaN if it was not solved.
struct LiveStride {
  std::uint32_t number = 0;
  double touchdown_speed_mps = 0.0;
  double peak_force_N = 0.0;
  double max_depth_m = 0.0;
  struct Stiffness {
    double value_N_per_m = 0.0;
    double low_N_per_m = 0.0;  // of the 95 % interval
    double high_N_per_m = 0.0;
    bool valid = false;
    std::string reason;  // reason why it is not valid, in words
  } observer_wls, joint;
  // Shape of the ground and force at 20 mm if a line is not valid, at most 42 characters; otherwise empty.
  std::string ground;
};

// Data that the view shows of one trial, updated by the lines of the cycle's process.
struct TrialModel {
  // Known before the trial begins.
  std::string title;                                       // "trial 2 of 5"
  std::string place;                                       // the board, in words
  std::string log;                                         // path of the log
  std::vector<std::pair<std::string, std::string>> sheet;  // the trial sheet: name, text
  CycleConfig config{};
  ConfigNode robot{};          // robot.toml: limits of faults
  double close_after_s = 0.0;  // of the view, once the trial is over and no key is pressed; 0: never
  std::string to_do = "a arms: the drives hold the leg, the encoders are checked";  // before arming

  bool ready = false;         // accepts words
  bool zero_checked = false;  // armed, and may be released
  bool over = false;          // the robot came to rest by itself, or was stopped, after a release
  bool quitting = false;
  bool ended = false;  // the log is closed
  State last_state = State::idle;
  Fault fault = Fault::none;
  std::string fault_values;  // measured and allowed values of the fault's check
  std::string error;
  std::optional<LiveStatus> status;
  std::optional<std::int64_t> released_ns;
  std::vector<LiveStride> strides;
  std::string known_ground;  // knowledge of the ground from all strides, with its depths
  std::string refusal;       // reason why the last key had no effect
  std::string ending;        // the exit summary in words
  // The newest last.
  std::deque<std::string> messages;
  std::deque<LiveStatus> history;

  static constexpr std::size_t kMessages = 200;
  static constexpr std::size_t kHistory = 2000;

  // Processes a line of hopperd. A line that is not its JSON is shown unchanged.
  void take(const std::string& line);
  void say(std::string message);

  State state() const { return status ? status->state : last_state; }
};

}  // namespace sandhopper
