#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/diagnose/next/none_planned.hpp"

namespace sandhopper::diagnose {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(DiagnoseNonePlanned, NamesTheKeysThatAreMissingOrSaysThatNoneIs) {
  Available available{{"amplitude_rad", {{0.1, 1.0}, true, {}}}, {"frequency_Hz", {{0.2, 2.0}, true, {}}}};
  EXPECT_THAT(why_none_is_planned(PlantKind::rotary_axis, Reach({}, available, {})),
              AllOf(HasSubstr("speed_radps, position_rad"), Not(HasSubstr("amplitude_rad"))));
  for (const char* key : {"speed_radps", "position_rad", "release_position_rad"})
    available[key] = {{0.1}, false, {}};
  EXPECT_THAT(why_none_is_planned(PlantKind::rotary_axis, Reach({}, available, {})),
              HasSubstr("no trial within what [available] lists"));
}

}  // namespace
}  // namespace sandhopper::diagnose
