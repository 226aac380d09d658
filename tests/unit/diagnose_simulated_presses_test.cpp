#include <gtest/gtest.h>

#include "tests/unit/campaign_folder.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/engine.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"
#include "tools/trial/campaign_maker.hpp"

namespace sandhopper::diagnose {
namespace {

// Camera at 240 Hz, two plates, speeds from slow to impact, and a steep unloading line. The camera's
// uncertainty of the turning depth is several newtons on this line and must not be named as physics.
TEST(DiagnoseSimulatedPresses, OurOwnAgreeWithTheirBelief) {
  CampaignFolder folder;
  CampaignMakerSetup setup;
  setup.folder = folder.path();
  setup.trials = 6;
  make_intrusion_campaign(setup);
  const auto answer = diagnose(read_campaign(load_campaign(folder.path())).recordings);
  EXPECT_EQ(answer.verdict, Verdict::consistent) << to_text(answer);
}

}  // namespace
}  // namespace sandhopper::diagnose
