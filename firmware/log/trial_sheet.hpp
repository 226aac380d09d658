#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/trial_logger.hpp"

namespace sandhopper {

// Information about a trial that only the experimenter has. In the log it is metadata "trial sheet"; as a
// file it is TOML with these keys.
struct TrialSheet {
  std::string who;
  std::string bed;              // the material
  std::string bed_preparation;  // treatment before each trial
  std::optional<double> release_height_m;
  double payload_kg = 0.0;
  std::string notes;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("who", self.who);
    visit("bed", self.bed);
    visit("bed_preparation", self.bed_preparation);
    visit("release_height_m", self.release_height_m, Range{0.0005, 1.0});
    visit("payload_kg", self.payload_kg, Range{0.0, 20.0});
    visit("notes", self.notes);
  }
};

inline constexpr std::string_view kSheetMetadata = "trial sheet";

// Keys and texts in the order of the fields, without empty ones.
std::vector<std::pair<std::string, std::string>> entries_of(const TrialSheet& sheet);
// Keys that a complete sheet has and this one lacks. Notes and payload are optional.
std::vector<std::string> missing_keys(const TrialSheet& sheet);

// Call it before the logger starts.
void add_sheet(TrialLogger& logger, const TrialSheet& sheet);
// The sheet in a log that was read at least to its first message.
std::optional<TrialSheet> sheet_of(const mcap::Reader& log);

}  // namespace sandhopper
