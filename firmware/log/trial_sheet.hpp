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

// What the experimenter knows of a trial and no sensor does. Kept in the log as metadata "trial sheet"; as a
// file it is TOML with these keys.
struct TrialSheet {
  std::string who;
  std::string bed;              // the material
  std::string bed_preparation;  // what is done to it before each trial
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

// Key and text, in the order of the fields; empty ones left out.
std::vector<std::pair<std::string, std::string>> entries_of(const TrialSheet& sheet);
// Keys that a whole sheet has and this one has not: notes and payload may be left out.
std::vector<std::string> missing_keys(const TrialSheet& sheet);

// Before the logger starts.
void add_sheet(TrialLogger& logger, const TrialSheet& sheet);
// Of a log that was read, at least to its first message.
std::optional<TrialSheet> sheet_of(const mcap::Reader& log);

}  // namespace sandhopper
