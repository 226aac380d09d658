#include <gtest/gtest.h>

#include <variant>

#include "tools/diagnose/answer/verdict.hpp"
#include "tools/diagnose/model/edits.hpp"

namespace sandhopper::diagnose {
namespace {

TEST(DiagnoseStates, ALawSeesTheStateOfItsPortAndNoOther) {
  Edits edits;
  edits.law(LawPort::axis, [](const AxisState& s) { return 2.0 * s.velocity_radps; });
  const auto laws = edits.at(LawPort::axis);
  EXPECT_DOUBLE_EQ(sum_of(laws, AxisState{.velocity_radps = 3.0}), 6.0);
  EXPECT_THROW(sum_of(laws, GroundState{.speed_mps = 3.0}), std::bad_variant_access);
  EXPECT_TRUE(edits.at(LawPort::joint).empty());
}

TEST(DiagnoseStates, ALawOfAnyStateActsAtEveryPort) {
  const Law time = law_of([](const PortState& s) { return time_of(s); });
  EXPECT_DOUBLE_EQ(time(RailState{.time_s = 0.5}), 0.5);
  EXPECT_DOUBLE_EQ(time(SensorState{.time_s = 0.25}), 0.25);
  EXPECT_DOUBLE_EQ(time(FootState{.radius_m = 0.04}), 0.0);
}

TEST(DiagnoseStates, EveryPortAnswersToItsName) {
  for (std::size_t i = 0; i < kLawPortNames.size(); ++i)
    EXPECT_EQ(law_port(kLawPortNames[i]), static_cast<LawPort>(i));
  EXPECT_EQ(name_of(LawPort::actuator_limit), "actuator.limit");
  EXPECT_EQ(name_of(Port::sensor), "sensor");
  EXPECT_THROW(law_port("ground.forse"), std::invalid_argument);
}

TEST(DiagnoseStates, AVerdictIsWrittenWithItsKind) {
  EXPECT_EQ(name_of(Verdict::unknown_physics, Detail::unknown_not_localised),
            "unknown_physics, unknown_not_localised");
  EXPECT_EQ(name_of(Verdict::consistent, Detail::none), "consistent");
  EXPECT_EQ(name_of(Verdict::consistent, Detail::only_beyond_spread), "consistent, only_beyond_spread");
  EXPECT_EQ(name_of(Detail::none), "null");
}

}  // namespace
}  // namespace sandhopper::diagnose
