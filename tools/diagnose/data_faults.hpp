#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/trial.hpp"

namespace sandhopper::diagnose {

// A channel that held a value, or fell to zero, while the quantity went on.
struct DataFault {
  std::string channel;
  std::string id;  // data.stuck, or data.dropout for stretches of a few samples
  std::size_t stretches = 0;
  double duration_s = 0.0;  // median of a stretch
  double rate_Hz = 0.0;     // stretches per second of recording
  bool borderline = false;  // as long as either
  std::vector<std::string> trials;
};

// Finds them, and empties the cells that hold no measurement. A resting or coarse sensor repeats values, too:
// a stretch counts where its neighbourhood shows that repeats of that length do not come by chance.
std::vector<DataFault> remove_data_faults(std::vector<Trial>& trials);

}  // namespace sandhopper::diagnose
