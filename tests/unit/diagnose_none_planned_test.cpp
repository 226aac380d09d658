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
              AllOf(HasSubstr("exclude every trial that is planned for this plant"),
                    HasSubstr("\"release\", \"sine\", \"chirp\" or \"ramp\"")));
  EXPECT_THAT(why_none_is_planned(PlantKind::rotary_axis, Reach({}, available, {}), "needs position_rad"),
              AllOf(HasSubstr("can be simulated: needs position_rad"), Not(HasSubstr("exclude"))));
}

}  // namespace
}  // namespace sandhopper::diagnose
