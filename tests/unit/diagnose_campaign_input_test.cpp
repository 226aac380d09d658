#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/campaign_folder.hpp"
#include "tools/diagnose/campaign_input.hpp"

namespace sandhopper::diagnose {
namespace {

// What ails a file that two trials share is told once, what ails another file as well.
TEST(DiagnoseCampaignInput, TellsWhatAilsASharedFileOnce) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "name = \"x\"\nplant = \"falling_body\"\n"
               "[every_trial]\nalso = { file = \"force.csv\", columns = { accel_mps2 = \"a\" } }\n"
               "[[trial]]\nfile = \"1.csv\"\n[[trial]]\nfile = \"2.csv\"\n[[trial]]\nfile = \"3.csv\"\n");
  folder.write("force.csv", "t_s,a\n0.0,0.0\n0.1,0.1\n0.2,0.2\n2.0,0.3\n2.1,0.4\n");
  for (const char* whole : {"1.csv", "2.csv"})
    folder.write(whole, "t_s,height_m\n0.0,1.0\n0.1,0.9\n0.2,0.8\n0.3,0.7\n");
  folder.write("3.csv", "t_s,height_m\n0.0,1.0\n0.1,0.9\n0.2,0.8\n2.0,0.7\n2.1,0.6\n");
  const auto input = read_campaign(load_campaign(folder.path()));
  EXPECT_EQ(input.recordings.trials.size(), 3u);
  const auto gaps_in = [&](const std::string& file) {
    return std::ranges::count_if(input.findings, [&](const Finding& f) {
      return f.kind == FindingKind::gap && f.file.ends_with(file);
    });
  };
  EXPECT_EQ(gaps_in("force.csv"), 1);
  EXPECT_EQ(gaps_in("3.csv"), 1);
}

}  // namespace
}  // namespace sandhopper::diagnose
