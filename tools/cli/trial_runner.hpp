#pragma once
#include <filesystem>

#include "config/robot_config.hpp"
#include "firmware/records.hpp"
#include "tools/cli/session.hpp"
#include "tools/cli/trial_options.hpp"
#include "tools/plant/world.hpp"
#include "tools/trial/live/live_trial.hpp"

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
  Outcome run(int number);  // from 0

 private:
  TrialSetup setup_of(int number) const;
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
};

}  // namespace sandhopper::cli
