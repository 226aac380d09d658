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

// Runs the trials of one command on the simulated board or on hopperd's board, with or without the live view.
// Each trial writes its own log; all results are read from the log.
class TrialRunner {
 public:
  struct Outcome {
    std::filesystem::path log;
    State last_state;
    Fault last_fault;
    bool connection_lost = false;
  };

  // Reads the whole configuration before it creates or starts anything.
  TrialRunner(Session& session, const TrialOptions& options);

  const RobotConfig& robot() const { return robot_; }
  const std::filesystem::path& folder() const { return folder_; }
  // True if the trials run in the live view.
  bool live() const { return live_; }
  // Runs trial `number`, counted from 0, of `trials`. The sheet is written into its log; the sheet's release
  // height overrides the option.
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
  std::optional<TrialSheet> sheet_{};  // of the present trial
};

}  // namespace sandhopper::cli
