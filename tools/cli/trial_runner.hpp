#pragma once
#include <filesystem>

#include "config/robot_config.hpp"
#include "firmware/records.hpp"
#include "tools/cli/session.hpp"
#include "tools/cli/trial_options.hpp"
#include "tools/plant/world.hpp"
#include "tools/trial/linux_trial.hpp"
#include "tools/trial/live/live_trial.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper::cli {

// Runs the trials of one command, each into a log of its own: on the simulated board or on hopperd's, with
// the operator at the live view or by itself. Both boards give a log; everything said afterwards is read from
// it.
class TrialRunner {
 public:
  struct Outcome {
    std::filesystem::path log;
    State last_state;
    Fault last_fault;
    bool connection_lost = false;
  };

  // Reads all of the configuration before anything is made or started.
  TrialRunner(Session& session, const TrialOptions& options);

  const RobotConfig& robot() const { return robot_; }
  const std::filesystem::path& folder() const { return folder_; }
  bool live() const { return live_; }
  // The next trial, counted from 0, of so many. A sheet goes into its log, and its release height goes before
  // the option.
  Outcome run(int number, int trials, const std::optional<TrialSheet>& sheet);

 private:
  TrialSetup setup_of(int number) const;
  SimTrialSetup simulated_setup(int number, const std::filesystem::path& log) const;
  LinuxTrialSetup linux_setup(int number, const std::filesystem::path& log);
  Outcome simulate(int number, const std::filesystem::path& log);
  Outcome run_linux(int number, const std::filesystem::path& log);
  Outcome run_live(int number, const std::filesystem::path& log);
  TrialModel model_of(int number, const std::filesystem::path& log) const;

  Session& session_;
  const TrialOptions& options_;
  bool live_;
  RobotConfig robot_;
  std::filesystem::path devices_;
  std::filesystem::path folder_;
  WorldConfig world_{};
  int trials_ = 1;
  std::optional<TrialSheet> sheet_{};  // of the trial that runs
};

}  // namespace sandhopper::cli
