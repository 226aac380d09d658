#include "tools/campaign/implausible.hpp"

#include <utility>

namespace sandhopper {

void add_implausible(TrialRecording& recording, const RecordingPlaces& places, FindingSeverity severity,
                     std::string_view channel, std::string what, std::string cure) {
  const std::uint64_t line = places.lines.empty() ? 1 : places.lines.front();
  recording.findings.push_back({FindingKind::implausible, severity, places.file, line, 1,
                                std::string(channel), std::move(what), std::move(cure)});
}

void doubt_column(TrialRecording& recording, const RecordingPlaces& places, bool stated,
                  std::string_view channel, std::string what, std::string cure) {
  add_implausible(recording, places, stated ? FindingSeverity::note : FindingSeverity::trial_unusable,
                  channel, std::move(what), stated ? "taken as stated in [columns]" : std::move(cure));
}

}  // namespace sandhopper
