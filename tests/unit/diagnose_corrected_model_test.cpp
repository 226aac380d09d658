#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/corrected_model.hpp"

namespace sandhopper::diagnose {
namespace {

// The number of `key` in a table of `toml`, which has one key per line.
std::optional<double> number(const std::string& toml, const std::string& table, const std::string& key) {
  const auto start = toml.find("\n[" + table + "]\n");
  if (start == std::string::npos) return {};
  const auto end = toml.find("\n[", start + 1);
  const auto at = toml.find("\n" + key + " = ", start);
  if (at == std::string::npos || at > end) return {};
  return std::stod(toml.substr(at + key.size() + 4));
}

Recordings believing(Recordings recordings, const std::string& key, double value) {
  recordings.belief.numbers[key] = value;
  for (auto& belief : recordings.beliefs) belief.numbers[key] = value;
  return recordings;
}

// A change of a number of the belief is reported as the change and as the new total. nominal.toml gets the
// total, and a second run with it must find nothing.
TEST(DiagnoseCorrectedModel, HoldsTheWholeOfWhatWasBelievedInPart) {
  // The true inertia is 0.12 kg m^2; the belief is 0.1.
  const auto recordings = swings([](double angle, double, double torque) {
    return (torque - 2.0 * std::sin(angle)) * (0.1 / 0.12 - 1.0);
  });
  const auto first = diagnose(recordings);
  ASSERT_EQ(first.verdict, Verdict::missing_physics);
  ASSERT_EQ(first.effects.front().id, "axis.inertia");
  const auto inertia_kg_m2 = number(first.corrected_model_toml, "axis", "inertia_kg_m2");
  ASSERT_TRUE(inertia_kg_m2) << first.corrected_model_toml;
  EXPECT_NEAR(*inertia_kg_m2, 0.12, 0.002);
  EXPECT_EQ(diagnose(believing(recordings, "axis.inertia_kg_m2", *inertia_kg_m2)).verdict,
            Verdict::consistent);
}

TEST(DiagnoseCorrectedModel, HoldsAHeavierBody) {
  // The true mass is 0.25 kg; the belief is 0.2 kg. The drag is known, so air slows the body less than
  // believed.
  const auto drag_N = [](double v) { return -0.5 * 1.2 * 0.01 * 0.9 * std::abs(v) * v; };
  auto recordings = drops([&](double, double, double v) { return drag_N(v) * 0.2 / 0.25; });
  recordings = believing(std::move(recordings), "medium.drag_coefficient", 0.9);
  const auto first = diagnose(recordings);
  ASSERT_EQ(first.verdict, Verdict::missing_physics);
  for (const auto& effect : first.effects)
    for (const auto& p : effect.parameters) {
      if (p.derived) continue;
      EXPECT_TRUE(first.corrected_model_toml.find(p.name + " = ") != std::string::npos) << p.name;
    }
  EXPECT_TRUE(first.corrected_model_toml.find('#') == std::string::npos) << first.corrected_model_toml;
}

// A stranger got some sixty numbers of sensors that he does not have.
TEST(DiagnoseCorrectedModel, IsTheAuthorsTextWithTheChangedLine) {
  auto recordings = swings([](double angle, double v, double torque) {
    return (torque - 2.0 * std::sin(angle)) * (0.1 / 0.12 - 1.0) - 0.05 * v;
  });
  const std::string own =
      "# my arm\n[axis]\ninertia_kg_m2 = 0.1   # kg m^2; from CAD\ngravity_torque_Nm = 2.0\n"
      "[sensors]\nposition_noise_rad = 0.0005\n";
  recordings.model_text = own;
  const auto text = diagnose(recordings).corrected_model_toml;
  EXPECT_THAT(text, ::testing::StartsWith("# my arm\n[axis]\ninertia_kg_m2 = 0.1"));
  EXPECT_THAT(text,
              ::testing::ContainsRegex("found by hop diagnose, axis.inertia: 0.1 before; kg m.2; from CAD"));
  EXPECT_THAT(text, ::testing::ContainsRegex(
                        "viscous_friction_Nm_s = [0-9.]+ +# found by hop diagnose, axis.viscous: "
                        ".*before, by default"));
  EXPECT_THAT(text, ::testing::HasSubstr("gravity_torque_Nm = 2.0\n"));
  EXPECT_THAT(text, ::testing::EndsWith("[sensors]\nposition_noise_rad = 0.0005\n"));
}

}  // namespace
}  // namespace sandhopper::diagnose
