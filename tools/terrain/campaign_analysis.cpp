#include "tools/terrain/campaign_analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/lost_forces.hpp"
#include "tools/campaign/mass_below_cell.hpp"
#include "tools/campaign/repeated_recordings.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper {
namespace {

void analyse_by(const TrialAnalysis& analysis, const CampaignTrial& trial, const TrialRecording& recording,
                TrialResult& result) {
  try {
    analysis.analyse(trial, recording, result);
  } catch (const std::exception& error) {
    result.ruled_out.push_back(fmt::format("the {}: the analysis failed: {}", analysis.name(), error.what()));
  }
}

// The bed's numbers are looked for, not used; a bed believed rigid is another analysis.
bool is_found_here(std::string_view key) { return key.starts_with("terrain.") && key != "terrain.rigid"; }

// `fingerprint`: of the recording.
TrialResult analyse_trial(const Campaign& campaign, const CampaignTrial& trial, Fingerprint& fingerprint) {
  auto recording = read_trial(campaign, trial, is_found_here);
  fingerprint = fingerprint_of(recording);
  leave_out_lost_forces(recording);
  add_mass_below_cell(recording, trial.belief);
  auto result = result_of(trial, recording);
  bool taken = false;
  for (const auto* analysis : all_analyses()) {
    if (!analysis->takes(campaign.plant, trial.kind)) continue;
    taken = true;
    if (result.usable) analyse_by(*analysis, trial, recording, result);
  }
  if (!taken)
    result.ruled_out.push_back(
        fmt::format("everything: a trial of kind \"{}\" on plant \"{}\" says nothing about the ground",
                    result.kind, name_of(campaign.plant)));
  return result;
}

// Takes away the figures of a recording that an earlier trial gave already. A part of a campaign knows only
// its own trials.
void count_once(const std::vector<const CampaignTrial*>& trials, std::vector<Fingerprint> fingerprints,
                std::vector<TrialResult>& results) {
  RepeatedRecordings repeated;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    auto twice = repeated.add(*trials[i], std::move(fingerprints[i]));
    if (!twice) continue;
    auto& result = results[i];
    result.usable = false;
    result.findings.push_back(std::move(*twice));
    result.quantities.clear();
    result.series.clear();
  }
}

}  // namespace

CampaignResults analyse_campaign(const Campaign& campaign, const AnalysisOptions& options) {
  CampaignResults results{.campaign = campaign.name,
                          .plant = campaign.plant,
                          .trials = campaign.trials.size(),
                          .part = options.part,
                          .parts = options.parts,
                          .findings = campaign.findings};
  for (auto& note : placeholder_notes(campaign, [](std::string_view key) { return !is_found_here(key); }))
    results.findings.push_back(std::move(note));
  std::vector<const CampaignTrial*> mine;
  for (const auto& trial : campaign.trials)
    if (trial.index % options.parts == options.part - 1) mine.push_back(&trial);
  results.results.resize(mine.size());
  std::vector<Fingerprint> fingerprints(mine.size());
  parallel_for(
      static_cast<long>(mine.size()), options.threads,
      [&](long i) {
        const auto place = static_cast<std::size_t>(i);
        results.results[place] = analyse_trial(campaign, *mine[place], fingerprints[place]);
      },
      [&](long done, long total) {
        if (options.progress)
          options.progress(static_cast<std::size_t>(done), static_cast<std::size_t>(total));
      });
  count_once(mine, std::move(fingerprints), results.results);
  return results;
}

CampaignResults merge_parts(std::vector<CampaignResults> parts) {
  if (parts.empty()) throw std::invalid_argument("nothing to merge");
  CampaignResults whole = std::move(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) {
    auto& part = parts[i];
    if (part.campaign != whole.campaign || part.plant != whole.plant || part.trials != whole.trials)
      throw std::invalid_argument(
          fmt::format("the parts are of different campaigns: \"{}\" with {} trials and \"{}\" with {}",
                      whole.campaign, whole.trials, part.campaign, part.trials));
    std::move(part.results.begin(), part.results.end(), std::back_inserter(whole.results));
  }
  std::sort(whole.results.begin(), whole.results.end(),
            [](const TrialResult& a, const TrialResult& b) { return a.index < b.index; });
  for (std::size_t i = 0; i < whole.results.size(); ++i) {
    if (whole.results[i].index == i) continue;
    const bool twice = i > 0 && whole.results[i].index == whole.results[i - 1].index;
    throw std::invalid_argument(fmt::format("trial {} of the campaign is in {}", twice ? i : i + 1,
                                            twice ? "two of the parts" : "none of the parts"));
  }
  if (whole.results.size() != whole.trials)
    throw std::invalid_argument(
        fmt::format("trial {} of the campaign is in none of the parts", whole.results.size() + 1));
  whole.part = whole.parts = 1;
  return whole;
}

}  // namespace sandhopper
