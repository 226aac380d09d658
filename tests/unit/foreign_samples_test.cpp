#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "firmware/log/csv_cells.hpp"
#include "read_campaign.hpp"
#include "tools/campaign/column_checks.hpp"
#include "tools/campaign/plausible.hpp"
#include "tools/campaign/written_unit.hpp"

// Samples that mean something else than they seem to: zeros that are none, rows that were filled in, counters
// that are full.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using enum FindingKind;

constexpr auto read = read_campaign;

// A plate that comes from 5 mm above the bed; 1500 N/m.
struct Press {
  double zero_N = 0.0, surface_m = 0.0, depth_scale = 1.0, exponent = 1.0;
};
std::string press(const Press& p) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 200; ++i) {
    const double depth = 2e-4 * i - 0.005,
                 force = 1500.0 * 0.035 * std::pow(std::max(0.0, depth / 0.035), p.exponent);
    text += fmt::format("{:.2f},{:.7f},{:.4f}\n", 0.01 * i, -p.depth_scale * (depth + p.surface_m),
                        force + p.zero_N + 0.02 * std::sin(7.0 * i * i));
  }
  return text;
}
const std::string kIntruder = "plant = \"intruder\"";

TEST(Surface, AForceAboveTheSurfaceIsSaidWithItsOffset) {
  const auto told = read(kIntruder, press({.zero_N = 12.0}));
  EXPECT_TRUE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("reads 12 N on average above the surface"));
  EXPECT_THAT(told.text, HasSubstr("offset = -12."));
  EXPECT_THAT(read(kIntruder, press({})).text, Not(HasSubstr("above the surface")));
}

TEST(Surface, ADepthThatIsCountedFromElsewhereIsSaid) {
  const auto told = read(kIntruder, press({.surface_m = 0.23}));
  EXPECT_THAT(told.text, HasSubstr("0.23 m below the surface before the bed bears anything"));
  EXPECT_THAT(told.text, HasSubstr("offset = 0.23"));
  // The hole of an earlier push is stated; the force of a cone grows late.
  const std::string pushed = kIntruder + "\n[every_trial]\npushes_since_preparation = 1";
  EXPECT_THAT(read(pushed, press({.surface_m = 0.23})).text, Not(HasSubstr("bears anything")));
  for (const double exponent : {1.0, 2.0, 3.0})
    EXPECT_THAT(read(kIntruder, press({.exponent = exponent})).text, Not(HasSubstr("bears anything")));
}

TEST(Surface, AFootThatHardlyMovesIsInDoubtUntilConfirmed) {
  const auto told = read(kIntruder, press({.depth_scale = 1e-3}));
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("foot_z_m: moves by 0.0398 mm in all"));
  const std::string own =
      kIntruder + "\n[columns]\nfoot_z_m = { column = \"foot_z_m\", unit = \"m\", scale = 1.0 }";
  EXPECT_TRUE(read(own, press({.depth_scale = 1e-3})).recording.usable());
}

TEST(FilledRows, ARestWithNoiseIsKept) {
  std::string text = press({}), filled = text;
  for (int i = 0; i < 50; ++i) {
    text += fmt::format("{:.2f},-0.0348000,{:.4f}\n", 2.0 + 0.01 * i, 52.2 + 0.02 * std::sin(7.0 * i * i));
    filled += fmt::format("{:.2f},-0.0348000,52.2000\n", 2.0 + 0.01 * i);
  }
  EXPECT_EQ(read(kIntruder, text).recording.rows(), 250U);
  EXPECT_EQ(read(kIntruder, filled).recording.rows(), 201U);
}

TEST(FullCounters, AreTakenAsGoingOnButStepsFromStopToStopAreNot) {
  std::vector<double> counted, steps;
  for (int i = 0; i < 300; ++i) {
    const double x = 9.0 * std::cos(0.02 * i) - 9.0;
    counted.push_back(x - 6.5536 * std::round(x / 6.5536));
    steps.push_back(i / 10 % 2 == 0 ? 0.5 : -0.5);
  }
  const auto counter = put_counter_back(counted);
  EXPECT_GE(counter.count, 4U);
  EXPECT_NEAR(counter.width, 6.5536, 0.02);
  for (int i = 0; i < 300; ++i)
    EXPECT_NEAR(counted[static_cast<std::size_t>(i)], 9.0 * std::cos(0.02 * i) - 9.0, 0.1) << i;
  const auto before = steps;
  EXPECT_EQ(put_counter_back(steps).count, 0U);
  EXPECT_EQ(steps, before);
}

TEST(Units, AFactorIsReadAndTheRangeOfASensorIsNone) {
  for (const auto& [name, to_si] : {std::pair{"Force [x10 N]", 10.0}, std::pair{"Depth [0.01 mm]", 1e-5},
                                    std::pair{"Depth (10^-3 m)", 1e-3}, std::pair{"Force (1e3 N)", 1e3}}) {
    ASSERT_TRUE(unit_in_name(name)) << name;
    EXPECT_NEAR(unit_in_name(name)->to_si / to_si, 1.0, 1e-9) << name;
  }
  const auto range = unit_in_name("Force (500 N)");
  EXPECT_TRUE(!range || range->to_si == 0.0 || range->to_si == 1.0);
  const auto mg = unit_in_name("acc_z (mg)");
  ASSERT_TRUE(mg);
  EXPECT_NEAR(factor_between(*mg, *unit_of_channel("accel_mps2")).value_or(0.0), 9.80665e-3, 1e-12);
}

TEST(Cells, AClearSignBetweenThousandsIsReadWhereNoneWasSeenBefore) {
  const NumberStyle comma{',', '\0'}, point{'.', '\0'};
  EXPECT_EQ(number_in_cell("1.007,59", comma), 1007.59);
  EXPECT_EQ(number_in_cell("1,007.59", point), 1007.59);
  EXPECT_FALSE(number_in_cell("1.007", comma)) << "may be 1.007";
  EXPECT_FALSE(number_in_cell("10.07,59", comma));
}

TEST(Cells, AMinusBehindAndIndianGroupsAreRead) {
  const NumberStyle comma{',', '\0'}, point{'.', '\0'}, grouped{'.', ','};
  EXPECT_EQ(number_in_cell("0.16-", point), -0.16);
  EXPECT_EQ(number_in_cell("1.234,5-", comma), -1234.5);
  for (const auto* text : {"-", "1--", "1e-", "-0.16-", "2023-09-", "A-"})
    EXPECT_FALSE(number_in_cell(text, point)) << text;
  EXPECT_FALSE(number_in_cell("5,-", comma)) << "a price without cents";
  EXPECT_FALSE(number_in_cell("5.-", point));
  for (const auto style : {point, grouped}) {
    EXPECT_EQ(number_in_cell("12,34,567.8", style), 1234567.8);
    EXPECT_EQ(number_in_cell("-1,00,000", style), -100000.0);
    for (const auto* text : {"1,00", "10,20,30", "1,000,00", "123,45,678", "0,12,345", "1,0,000", ",00,000"})
      EXPECT_FALSE(number_in_cell(text, style)) << text;
  }
  EXPECT_FALSE(number_in_cell("1,00,000", comma));
  EXPECT_FALSE(number_in_cell("1,234", point)) << "may be 1.234";
}

// A free pendulum; from row 200 on its zero is another one by `step_rad`.
std::string pendulum(double step_rad) {
  std::string text = "t_s,position_rad\n";
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{:.3f},{:.5f}\n", 0.005 * i,
                        0.5 * std::exp(-0.0005 * i) * std::cos(0.022 * i) + (i < 200 ? 0.0 : step_rad));
  return text;
}

TEST(ValueSteps, APositionWhoseZeroIsSetAnewIsInDoubt) {
  const std::string axis = "plant = \"rotary_axis\"";
  const auto told = read(axis, pendulum(-2.0));
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("in line 202 and goes on from there"));
  EXPECT_THAT(told.text, HasSubstr("select = { to_line = 201 } and select = { from_line = 202 }"));
  EXPECT_TRUE(read(axis, pendulum(0.0)).recording.usable());
}

TEST(ValueSteps, TooFewDigitsAreSaid) {
  std::string coarse = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 200; ++i)
    coarse += fmt::format("{:.2f},{:.5f},{:.0f}\n", 0.01 * i, -1e-4 * i, 10.0 * std::round(0.03 * i));
  EXPECT_THAT(read(kIntruder, coarse).text,
              HasSubstr("force_N: takes only 7 different values in 200 samples, 10"));
  EXPECT_THAT(read(kIntruder, press({})).text, Not(HasSubstr("different values")));
}

// The foot goes on, the force stays at 30 N to the end of the recording; a foot that stops lets it stay, too.
TEST(Saturation, AForceThatStopsWhileTheFootGoesOnIsSeenAtTheEnd) {
  for (const bool goes_on : {true, false}) {
    std::string text = "t_s,foot_z_m,force_N\n";
    for (int i = 0; i < 200; ++i)
      text += fmt::format("{:.2f},{:.5f},{:.4f}\n", 0.01 * i, -2e-4 * (goes_on ? i : std::min(i, 100)),
                          i < 100 ? 0.3 * i + 0.02 * std::sin(7.0 * i * i) : 30.0);
    EXPECT_EQ(read(kIntruder, text).text.find("force_N: is saturated") != std::string::npos, goes_on);
  }
}

// Specific force of a phone in m/s2 for 4 s.
std::string phone(double at_rest) {
  std::string text = "t_s,accel_mps2\n";
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{:.2f},{:.4f}\n", 0.01 * i,
                        (i > 150 && i < 210 ? 0.0 : at_rest) + 0.02 * std::sin(7.0 * i * i));
  return text;
}

TEST(Axes, AnAxisAcrossTheFallIsInDoubt) {
  const std::string body = "plant = \"falling_body\"";
  EXPECT_THAT(read(body, phone(0.3)).text, HasSubstr("reads less than half of gravity for 3.99 s on end"));
  EXPECT_FALSE(read(body, phone(0.3)).recording.usable());
  EXPECT_TRUE(read(body, phone(9.81)).recording.usable());
}

TEST(Beliefs, AMassInGramsIsAskedFor) {
  CampaignFolder folder;
  folder.write("campaign.toml",
               "plant = \"falling_body\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  const auto told = [&](const char* mass) {
    folder.write("nominal.toml", fmt::format("[body]\nmass_kg = {}\n", mass));
    std::string text;
    for (const auto& finding : implausible_beliefs(load_campaign(folder.path()))) text += to_string(finding);
    return text;
  };
  EXPECT_THAT(told("57.0"), HasSubstr("is not dropped by hand; is it in g?"));
  EXPECT_EQ(told("5.7"), "");
}

// The motors pull apart a little, as the commands ask.
std::string two_motors(double side) {
  std::string text =
      "t_s,command_left_torque_Nm,command_right_torque_Nm,motor_left_current_A,motor_right_current_A\n";
  for (int i = 0; i < 200; ++i) {
    const double both = -2.0 - std::sin(0.03 * i), apart = 0.2 * std::sin(0.2 * i);
    text += fmt::format("{:.3f},{:.4f},{:.4f},{:.4f},{:.4f}\n", 0.001 * i, both + apart, both - apart,
                        10.0 * (both + side * apart), 10.0 * (both - side * apart));
  }
  return text;
}

TEST(Hopper, MotorsThatAreBothExchangedAreSeenByTheirCommands) {
  const std::string hopper = "plant = \"hopper\"";
  const auto exchanged = read(hopper, two_motors(-1.0));
  EXPECT_FALSE(exchanged.recording.usable());
  EXPECT_THAT(exchanged.text, HasSubstr("left and right are exchanged"));
  EXPECT_THAT(read(hopper, two_motors(1.0)).text, Not(HasSubstr("exchanged")));
}

}  // namespace
}  // namespace sandhopper
