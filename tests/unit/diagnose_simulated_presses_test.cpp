#include <gtest/gtest.h>

#include "tests/unit/campaign_folder.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/engine.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"
#include "tools/trial/campaign_maker.hpp"

namespace sandhopper::diagnose {
namespace {

// A camera of 240 frames a second, two plates, speeds from a creep to a blow, and a steep line back: what the
// camera leaves unsure of the turning depth is newtons on that line, and no physics.
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
