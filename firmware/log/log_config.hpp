#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "config/fields.hpp"
#include "firmware/log/segmented_log.hpp"

namespace sandhopper {

// Division of a long log into files, its disk quota, and the folder of the freeze frames (firmware/freeze).
// Megabytes are 10^6 bytes.
struct LogConfig {
  int segment_MB = 200;  // a new file begins when one reaches this size; 0: one file
  int quota_MB = 4000;   // beyond this sum the oldest files of this log are removed; 0: none is removed
  std::string freeze_folder{};  // empty: the state folder of the service or of the user
  int freeze_files = 20;        // number of newest frames that are kept; one has about 4 MB

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("segment_MB", self.segment_MB, Range{0, 1000000});
    visit("quota_MB", self.quota_MB, Range{0, 1000000});
    visit("freeze_folder", self.freeze_folder);
    visit("freeze_files", self.freeze_files, Range{1, 10000});
  }

  // Only whole files are removed, and neither the present nor the previous one. So two files must fit.
  template <class Report>
  void check(Report&& report) const {
    if (quota_MB == 0) return;
    if (segment_MB == 0)
      report("quota_MB", fmt::format("expected 0 (none) where segment_MB is 0, because a log in one file has "
                                     "no older file to remove, got {}; set segment_MB, too",
                                     quota_MB));
    else if (quota_MB < 2 * segment_MB)
      report("quota_MB", fmt::format("expected 0 (none) or at least two files of segment_MB ({}): the one "
                                     "being written and the one before it, got {}; write {} or more",
                                     segment_MB, quota_MB, 2 * segment_MB));
  }

  SegmentLimits limits() const {
    constexpr std::uint64_t kMegabyte = 1'000'000;
    return {.segment_bytes = kMegabyte * static_cast<std::uint64_t>(segment_MB),
            .quota_bytes = kMegabyte * static_cast<std::uint64_t>(quota_MB)};
  }
};

}  // namespace sandhopper
