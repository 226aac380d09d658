#include <gtest/gtest.h>

#include "tools/diagnose/discrepancy/law_limits.hpp"

// Limits from which a law of free form is unknown physics: each with a case just inside and one just outside.
namespace sandhopper::diagnose {
namespace {

// A law of the plant that all trials show clearly.
FreeGain law(double held_out, double p_value = 1e-4, double trials_better = 1.0) {
  FreeGain gain{{.port = "ground", .variable = "depth_m", .knots = {}, .terms = {}},
                held_out,
                trials_better,
                p_value,
                {},
                {}};
  gain.size = Eigen::VectorXd::Constant(9, 1.0);
  return gain;
}
FreeGain of_sensor(FreeGain gain) {
  gain.family.sensor = true;
  return gain;
}

TEST(DiagnoseLawLimits, TheLeastGainGrowsWithRowsDevianceAndForm) {
  const BestNames little{.rows = 100.0, .deviance = 100.0, .form_error = 0.001};
  EXPECT_NEAR(least_gain_of_law(little), 25.0, 1e-9);
  const BestNames many_rows{.rows = 1e5, .deviance = 100.0, .form_error = 0.001};
  EXPECT_NEAR(least_gain_of_law(many_rows), 400.0, 1e-9);
  const BestNames unsure_form{.rows = 100.0, .deviance = 1e5, .form_error = 0.05};
  EXPECT_NEAR(least_gain_of_law(unsure_form), 3000.0, 1e-9);
  const BestNames sure_form{.rows = 100.0, .deviance = 1e5, .form_error = 0.001};
  EXPECT_NEAR(least_gain_of_law(sure_form), 1000.0, 1e-9);
  const BestNames large{.rows = 100.0, .deviance = 100.0, .explained = 1e6, .form_error = 0.001};
  EXPECT_NEAR(least_gain_of_law(large), 1000.0, 1e-9);
}

TEST(DiagnoseLawLimits, ALawBesideNamesNeedsThreeInAThousand) {
  EXPECT_TRUE(is_law_beside(law(100.0, 0.0028), 1000.0));
  EXPECT_FALSE(is_law_beside(law(100.0, 0.0032), 1000.0));
}

TEST(DiagnoseLawLimits, AnUnmistakableOneNeedsFivePerCent) {
  EXPECT_TRUE(is_law_beside(law(320.0, 0.045), 1000.0));
  EXPECT_FALSE(is_law_beside(law(320.0, 0.055), 1000.0));
  EXPECT_FALSE(is_law_beside(law(280.0, 0.045), 1000.0));
}

TEST(DiagnoseLawLimits, ThreeQuartersOfTheTrialsMustImprove) {
  for (const bool enough : {true, false}) {
    const double better = enough ? 0.76 : 0.74;
    EXPECT_EQ(is_law_beside(law(100.0, 1e-4, better), 1000.0), enough);
    EXPECT_EQ(is_law_of_balance(law(0.9, 1e-4, better)), enough);
    EXPECT_EQ(is_law_in_place_of_faults(law(100.0, 1e-4, better), 50.0), enough);
    EXPECT_EQ(outdoes_names(law(100.0, 1e-4, better), {.rows = 100.0, .deviance = 100.0}), enough);
  }
}

TEST(DiagnoseLawLimits, AMinuteLawIsNone) {
  auto seen = law(100.0), minute = law(100.0);
  seen.size.setConstant(-0.11);
  minute.size.setConstant(0.09);
  EXPECT_TRUE(is_law_beside(seen, 1000.0));
  EXPECT_FALSE(is_law_beside(minute, 1000.0));
}

TEST(DiagnoseLawLimits, TheMostProbableLawNeedsAGainOf25) {
  EXPECT_FALSE(is_likely_law(law(24.0)));
  EXPECT_TRUE(is_likely_law(law(26.0)));
}

TEST(DiagnoseLawLimits, ABalanceShowsALawByAQuarterOfTheVariance) {
  EXPECT_FALSE(is_law_of_balance(law(0.23)));
  EXPECT_TRUE(is_law_of_balance(law(0.27)));
  EXPECT_TRUE(is_law_of_balance(law(0.5, 0.009)));
  EXPECT_FALSE(is_law_of_balance(law(0.5, 0.011)));
  auto of_torque = law(0.5), of_time = law(0.5);
  of_torque.family.variable = "torque_Nm";
  of_time.family.variable = "t_s";
  EXPECT_FALSE(is_law_of_balance(of_torque));
  EXPECT_FALSE(is_law_of_balance(of_time));
}

TEST(DiagnoseLawLimits, SmallFaultsGiveWayToALawThatGainsMore) {
  EXPECT_FALSE(is_law_in_place_of_faults(law(48.0), 50.0));
  EXPECT_TRUE(is_law_in_place_of_faults(law(52.0), 50.0));
  EXPECT_FALSE(is_law_in_place_of_faults(law(24.0), 5.0));
  EXPECT_TRUE(is_law_in_place_of_faults(law(52.0, 0.045), 50.0));
  EXPECT_FALSE(is_law_in_place_of_faults(law(52.0, 0.055), 50.0));
  EXPECT_FALSE(is_law_in_place_of_faults(of_sensor(law(52.0)), 50.0));
}

TEST(DiagnoseLawLimits, NamesAreOutdoneByThirtyPerCent) {
  const BestNames names{.rows = 1000.0, .deviance = 1000.0, .explained = 1000.0};
  EXPECT_FALSE(outdoes_names(law(1300.0), names));
  EXPECT_TRUE(outdoes_names(law(1350.0), names));
  EXPECT_TRUE(outdoes_names(law(1350.0, 0.045), names));
  EXPECT_FALSE(outdoes_names(law(1350.0, 0.055), names));
}

// No law is tried that would have to fit better than noise.
TEST(DiagnoseLawLimits, NoLawUndercutsTheNoise) {
  EXPECT_FALSE(may_be_outdone({.rows = 1000.0, .deviance = 760.0}));
  EXPECT_TRUE(may_be_outdone({.rows = 1000.0, .deviance = 790.0}));
  EXPECT_TRUE(may_be_outdone({.rows = 1000.0, .deviance = 1000.0, .explained = 700.0}));
  EXPECT_FALSE(may_be_outdone({.rows = 1000.0, .deviance = 1000.0, .explained = 800.0}));
}

TEST(DiagnoseLawLimits, AnErrorOfTheFormGainsLittle) {
  EXPECT_FALSE(is_beyond_form(law(100.0), 0.15, 1000.0));
  EXPECT_TRUE(is_beyond_form(law(100.0), 0.17, 1000.0));
  EXPECT_FALSE(is_beyond_form(of_sensor(law(100.0)), 0.28, 1000.0));
  EXPECT_TRUE(is_beyond_form(of_sensor(law(100.0)), 0.32, 1000.0));
  EXPECT_FALSE(is_beyond_form(law(280.0), 0.01, 1000.0));
  EXPECT_TRUE(is_beyond_form(law(320.0), 0.01, 1000.0));
}

TEST(DiagnoseLawLimits, BesideNamesLessLeaningIsUnknown) {
  EXPECT_FALSE(is_unknown_shift(-4.3, true));
  EXPECT_TRUE(is_unknown_shift(-4.7, true));
  EXPECT_FALSE(is_unknown_shift(5.8, false));
  EXPECT_TRUE(is_unknown_shift(6.2, false));
}

// p of one gain: that of a normal variable, at most 1 % from 2.58 standard deviations on.
TEST(DiagnoseLawLimits, OneTrialShowsALawByItsGainAlone) {
  EXPECT_EQ(p_of_gains({6.0}, 1.0), 1.0);
  EXPECT_LE(p_of_gains({7.0}, 1.0), 0.01);
  EXPECT_EQ(p_of_gains({24.0}, 2.0), 1.0);
  EXPECT_LE(p_of_gains({28.0}, 2.0), 0.01);
}

}  // namespace
}  // namespace sandhopper::diagnose
