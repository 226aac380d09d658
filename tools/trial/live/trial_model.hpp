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

// A stride as the operator is told of it; NaN where it was not solved.
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
    std::string reason;  // why not valid, in words
  } observer_wls, joint;
  // Shape of the ground and force at 20 mm where a line is not valid, at most 42 characters; else empty.
  std::string ground;
};

// What the view shows of one trial, kept up to date by the lines that the cycle's process says.
struct TrialModel {
  // What is known before it begins.
  std::string title;                                       // "trial 2 of 5"
  std::string place;                                       // which board, in words
  std::string log;                                         // its file
  std::vector<std::pair<std::string, std::string>> sheet;  // the trial sheet: name, text
  CycleConfig config{};
  ConfigNode robot{};          // robot.toml: limits of faults
  double close_after_s = 0.0;  // of the view, once the trial is over and no key is pressed; 0: never
  std::string to_do = "a arms: the drives hold the leg, the encoders are checked";  // before arming

  bool ready = false;         // takes words
  bool zero_checked = false;  // armed, and may be released
  bool over = false;          // the robot came to rest by itself, or was stopped, after a release
  bool quitting = false;
  bool ended = false;  // the log is closed
  State last_state = State::idle;
  Fault fault = Fault::none;
  std::string fault_values;  // what the fault's check saw and allows
  std::string error;
  std::optional<LiveStatus> status;
  std::optional<std::int64_t> released_ns;
  std::vector<LiveStride> strides;
  std::string known_ground;  // what all strides together know of the ground, and at which depths
  std::string refusal;       // why the last key did nothing
  std::string ending;        // the exit summary in words
  // The newest last.
  std::deque<std::string> messages;
  std::deque<LiveStatus> history;

  static constexpr std::size_t kMessages = 200;
  static constexpr std::size_t kHistory = 2000;

  // A line of hopperd's; one that is not its JSON is shown as it is.
  void take(const std::string& line);
  void say(std::string message);

  State state() const { return status ? status->state : last_state; }
};

}  // namespace sandhopper
