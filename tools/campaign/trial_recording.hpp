#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/finding.hpp"

namespace sandhopper {

// Rows in which a channel was at the end of its range. Their values are bounds, not measurements.
struct SaturatedRows {
  std::string channel;
  double limit = 0.0;
  bool at_top = true;
  std::size_t rows = 0;  // total number
};

// One trial as channels in SI units. Times grow strictly. NaN: no sample in that row. Channels that must not
// be used are not included; `findings` gives the reasons.
class TrialRecording {
 public:
  struct Channel {
    std::string name;
    std::vector<double> values;
  };

  std::vector<double> t_s;
  std::vector<Channel> channels;
  // Unused channels that were saturated for too long, or constant throughout.
  std::vector<Channel> at_one_value;
  bool own_log = false;  // Log of this firmware, not a foreign table.
  bool has_time = true;  // False: force against depth without time; t_s is the row number 0, 1, 2, …
  std::vector<std::string> unused_columns;  // Columns of the file that no channel or mapping uses.
  std::vector<SaturatedRows> saturated;
  std::vector<Finding> findings;

  std::size_t rows() const { return t_s.size(); }
  bool usable() const { return !any_unusable(findings) && !t_s.empty(); }
  bool has(std::string_view name) const { return find(name) != nullptr; }
  // Throws std::out_of_range if there is no such channel.
  std::span<const double> channel(std::string_view name) const;
  const std::vector<double>* find(std::string_view name) const;
  const SaturatedRows* saturation(std::string_view name) const;
  // True if the channel is at the end of its range in this row.
  bool is_saturated(std::string_view name, std::size_t row) const;
};

// Reads a trial's recording: a table (.csv, .txt, …), a .mcap log of this firmware, or the folder of a hop
// that holds one of either. Never throws for bad input; findings say what is wrong, and usable() whether
// enough is left. A trial with a number that nobody stated ("?") is ruled out, unless `can_do_without` is
// true for its key: then a note says that it was not needed.
TrialRecording read_trial(
    const Campaign& campaign, const CampaignTrial& trial,
    const std::function<bool(std::string_view key)>& can_do_without = [](std::string_view) { return false; });

}  // namespace sandhopper
