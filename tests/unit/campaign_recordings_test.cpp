#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "campaign_folder.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/campaign/recordings_folder.hpp"

namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr auto kElsewhere =
    "plant = \"intruder\"\ndata = \"plates\"\nsource = \"They are at https://example.org.\"\n"
    "[[trial]]\nfile = \"a.csv\"\nalso = { file = \"b.csv\" }\n";

class CampaignRecordings : public ::testing::Test {
 protected:
  void TearDown() override { ::unsetenv("SANDHOPPER_DATA"); }
};

TEST_F(CampaignRecordings, ThatAreNotHereAreRefusedWithWhereToGetThem) {
  ::unsetenv("SANDHOPPER_DATA");
  CampaignFolder folder;
  folder.write("campaign.toml", kElsewhere);
  try {
    load_campaign(folder.path());
    FAIL() << "a campaign without its recordings was loaded";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.problems().front().key, "data");
    EXPECT_THAT(error.what(), AllOf(HasSubstr("campaign.toml:2:8"), HasSubstr("https://example.org"),
                                    HasSubstr("SANDHOPPER_DATA"), HasSubstr("'plates'")));
  }
}

TEST_F(CampaignRecordings, AreFoundInSandhopperData) {
  CampaignFolder folder, data;
  folder.write("campaign.toml", kElsewhere);
  data.write("plates/a.csv", "t_s\n");
  ::setenv("SANDHOPPER_DATA", data.path().c_str(), 1);
  const auto campaign = load_campaign(folder.path());
  EXPECT_EQ(campaign.trials.at(0).file, data.path() / "plates/a.csv");
  EXPECT_EQ(campaign.trials.at(0).companions.at(0).file, data.path() / "plates/b.csv");
  EXPECT_TRUE(campaign.findings.empty());
}

TEST_F(CampaignRecordings, AreFoundBesideTheCampaignAndInSharedDataAboveIt) {
  ::unsetenv("SANDHOPPER_DATA");
  CampaignFolder folder;
  folder.write("one/two/campaign.toml", kElsewhere);
  folder.write("shared/data/plates/a.csv", "t_s\n");
  EXPECT_EQ(load_campaign(folder.path() / "one/two").recordings, folder.path() / "shared/data/plates");
  folder.write("one/two/plates/a.csv", "t_s\n");
  EXPECT_EQ(load_campaign(folder.path() / "one/two").recordings, folder.path() / "one/two/plates");
}

}  // namespace
}  // namespace sandhopper
