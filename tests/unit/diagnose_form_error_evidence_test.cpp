#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/evidence/form_error_evidence.hpp"

// Error in the form of a law that a campaign with a known effect shows.
namespace sandhopper::diagnose {
namespace {

constexpr std::array kShares{0.1, 1.0, 10.0};

// Viscous friction whose coefficient differs by the share `differs` over the angle; the candidate's is
// constant.
Recordings rubbing(double differs) {
  return swings(
      [=](double angle, double w, double) { return -0.05 * (1.0 + differs * std::sin(3.0 * angle)) * w; });
}

TEST(DiagnoseFormErrorEvidence, ALawOfTheRightFormHasLittleErrorOfForm) {
  const auto right = form_error_evidence(rubbing(0.0), "axis.viscous", kShares);
  ASSERT_EQ(right.size(), kShares.size());
  for (const double value : right) EXPECT_TRUE(std::isfinite(value));
  EXPECT_GT(right[0], right[2]);
  const auto other = form_error_evidence(rubbing(0.8), "axis.viscous", kShares);
  ASSERT_EQ(other.size(), kShares.size());
  EXPECT_GT(other[2], other[0]);
}

TEST(DiagnoseFormErrorEvidence, AReadingOrAnUnknownNameHasNone) {
  EXPECT_TRUE(form_error_evidence(rubbing(0.0), "encoder.offset", kShares).empty());
  EXPECT_TRUE(form_error_evidence(rubbing(0.0), "axis.nothing", kShares).empty());
}

}  // namespace
}  // namespace sandhopper::diagnose
