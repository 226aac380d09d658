#include "firmware/log/trial_sheet.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace sandhopper {

std::vector<std::pair<std::string, std::string>> entries_of(const TrialSheet& sheet) {
  std::vector<std::pair<std::string, std::string>> entries;
  TrialSheet::fields(sheet, [&]<class Member>(std::string_view key, const Member& member, Range = {}) {
    if constexpr (std::same_as<Member, std::string>) {
      if (!member.empty()) entries.emplace_back(key, member);
    } else if constexpr (std::same_as<Member, double>) {
      entries.emplace_back(key, fmt::format("{}", member));
    } else if (member) {
      entries.emplace_back(key, fmt::format("{}", *member));
    }
  });
  return entries;
}

std::vector<std::string> missing_keys(const TrialSheet& sheet) {
  std::vector<std::string> missing;
  if (sheet.who.empty()) missing.emplace_back("who");
  if (sheet.bed.empty()) missing.emplace_back("bed");
  if (sheet.bed_preparation.empty()) missing.emplace_back("bed_preparation");
  if (!sheet.release_height_m) missing.emplace_back("release_height_m");
  return missing;
}

void add_sheet(TrialLogger& logger, const TrialSheet& sheet) {
  const auto entries = entries_of(sheet);
  logger.add_metadata(kSheetMetadata, {entries.begin(), entries.end()});
}

std::optional<TrialSheet> sheet_of(const mcap::Reader& log) {
  for (const auto& metadata : log.metadata()) {
    if (metadata.name != kSheetMetadata) continue;
    TrialSheet sheet;
    TrialSheet::fields(sheet, [&]<class Member>(std::string_view key, Member& member, Range = {}) {
      const auto found = metadata.entries.find(std::string(key));
      if (found == metadata.entries.end()) return;
      if constexpr (std::same_as<Member, std::string>)
        member = found->second;
      else
        member = std::strtod(found->second.c_str(), nullptr);
    });
    return sheet;
  }
  return std::nullopt;
}

}  // namespace sandhopper
