#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tools/campaign/trial_recording.hpp"

namespace sandhopper {

// A campaign in a temporary folder, deleted by the destructor.
class CampaignFolder {
 public:
  CampaignFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("sandhopper_campaign_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~CampaignFolder() { std::filesystem::remove_all(path_); }
  CampaignFolder(const CampaignFolder&) = delete;
  CampaignFolder& operator=(const CampaignFolder&) = delete;

  CampaignFolder& write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return *this;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// The first finding of a kind; null if there is none.
inline const Finding* find(const TrialRecording& recording, FindingKind kind) {
  for (const auto& finding : recording.findings)
    if (finding.kind == kind) return &finding;
  return nullptr;
}

}  // namespace sandhopper
