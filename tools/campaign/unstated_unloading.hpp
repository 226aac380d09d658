#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// Collects the trials of a plate whose rows after the deepest point are compared with an unloading line that
// nobody stated (terrain.unloading_stiffness_ratio). Without it the force is taken to fall as it rose.
class UnstatedUnloading {
 public:
  explicit UnstatedUnloading(const Campaign& campaign);

  // Counts a trial's rows in the bed after its deepest point. A trial in which the plate does not rise again
  // by more than the noise of its depth has none.
  void add(const CampaignTrial& trial, const TrialRecording& recording);

  // One note for all trials, with the time at which each would have to end. Empty if there is none.
  std::optional<Finding> finding() const;

 private:
  struct Ends {
    std::string trial;
    double to_s = 0.0;
  };

  std::string file_;
  bool is_unstated_ = false;
  std::size_t rows_ = 0;
  std::vector<Ends> ends_{};
};

}  // namespace sandhopper
