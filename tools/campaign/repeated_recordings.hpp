#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A channel, or its part around its largest value if it is long.
struct ChannelPart {
  std::string name;
  std::vector<double> t_s, values;
};

// The features by which a recording is recognised.
struct Fingerprint {
  std::uint64_t exact =
      0;  // of channels and values, not times; 0: another recording could equal it by chance
  std::vector<ChannelPart> noisy{};   // channels that show noise
  std::vector<ChannelPart> smooth{};  // the others
};

Fingerprint fingerprint_of(const TrialRecording& recording);

// True if two recordings share their noise in every channel in which both show noise, and differ by no more
// than their digits in the others: one is the other with other digits, fewer rows, a cut begin or end,
// another begin of its clock or another zero.
bool have_one_noise(const Fingerprint& a, const Fingerprint& b);

// Finds one recording that a campaign lists twice, also under another name or with another set-up. Noise
// never repeats, so a second trial with the same samples is no second measurement.
class RepeatedRecordings {
 public:
  // The finding of a trial whose samples an earlier one has; it makes the trial unusable.
  std::optional<Finding> add(const CampaignTrial& trial, Fingerprint fingerprint);

 private:
  struct Known {
    Fingerprint fingerprint;
    const CampaignTrial* trial;
  };
  std::vector<Known> known_;
};

}  // namespace sandhopper
