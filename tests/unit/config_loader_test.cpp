#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/json.hpp"
#include "config/load.hpp"

namespace sandhopper {

enum class Surface : std::uint8_t { sand, wood, none };
template <>
struct EnumNames<Surface> {
  static constexpr std::array<std::string_view, 3> value{"sand", "wood", "none"};
};

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Inner {
  double mass_kg = 1.0;
  std::uint8_t id = 1;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("mass_kg", self.mass_kg, Range{0.0, 50.0});
    visit("id", self.id);
  }
};

struct Limits {
  double low_m = 0.1;
  double high_m = 0.2;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("low_m", self.low_m);
    visit("high_m", self.high_m);
  }

  template <class Report>
  void check(Report&& report) const {
    if (!(low_m < high_m)) report("low_m", "expected less than high_m");
  }
};

struct Sample {
  double stiffness_N_per_m = 250.0;
  int count = 3;
  std::int64_t time_ns = 0;
  bool enabled = true;
  std::string name = "default";
  Surface surface = Surface::sand;
  Inner inner;
  std::array<double, 3> offset_mps2{};
  std::array<Inner, 2> motor{};
  std::vector<Inner> extra;
  std::vector<double> rates_Hz;
  std::optional<double> trim_rad;
  Limits limits;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("stiffness_N_per_m", self.stiffness_N_per_m, Range{0.0, 1e5});
    visit("count", self.count, Range{1, 9});
    visit("time_ns", self.time_ns);
    visit("enabled", self.enabled);
    visit("name", self.name);
    visit("surface", self.surface);
    visit("inner", self.inner);
    visit("offset_mps2", self.offset_mps2, Range{-1.0, 1.0});
    visit("motor", self.motor);
    visit("extra", self.extra);
    visit("rates_Hz", self.rates_Hz);
    visit("trim_rad", self.trim_rad, Range{-1.0, 1.0});
    visit("limits", self.limits);
  }
};

std::vector<std::string> problems_of(std::string_view text, MissingKeys missing = MissingKeys::use_default) {
  try {
    load_text<Sample>("f.toml", text, missing);
  } catch (const ConfigError& error) {
    std::vector<std::string> lines;
    for (const auto& problem : error.problems()) lines.push_back(to_string(problem));
    return lines;
  }
  return {};
}

TEST(ConfigLoader, ReadsEveryKindOfMember) {
  const auto s = load_text<Sample>("f.toml", R"(
stiffness_N_per_m = 375
count = 4
time_ns = 1234567890123456789
enabled = false
name = "sand \"box\""
surface = "wood"
offset_mps2 = [0.5, -1, 0.0]
rates_Hz = [833.0, 1666]
trim_rad = -0.25
[inner]
mass_kg = 0.5
id = 255
[[motor]]
mass_kg = 1.5
id = 7
[[motor]]
mass_kg = 2.5
id = 8
[[extra]]
mass_kg = 3.5
id = 9
[limits]
low_m = 0.3
high_m = 0.4
)");
  EXPECT_EQ(s.stiffness_N_per_m, 375.0);
  EXPECT_EQ(s.count, 4);
  EXPECT_EQ(s.time_ns, 1234567890123456789);
  EXPECT_FALSE(s.enabled);
  EXPECT_EQ(s.name, "sand \"box\"");
  EXPECT_EQ(s.surface, Surface::wood);
  EXPECT_EQ(s.inner.id, 255);
  EXPECT_THAT(s.offset_mps2, ElementsAre(0.5, -1.0, 0.0));
  EXPECT_EQ(s.motor[1].mass_kg, 2.5);
  ASSERT_EQ(s.extra.size(), 1U);
  EXPECT_EQ(s.extra[0].id, 9);
  EXPECT_THAT(s.rates_Hz, ElementsAre(833.0, 1666.0));
  EXPECT_EQ(s.trim_rad, -0.25);
  EXPECT_EQ(s.limits.high_m, 0.4);
}

TEST(ConfigLoader, WhatIsWrittenReadsBackToTheSameBits) {
  Sample s;
  s.stiffness_N_per_m = 1.0 / 3.0;
  s.name = "tab\tquote\"back\\slash";
  s.surface = Surface::none;
  s.offset_mps2 = {1e-17, -0.0, 1.0};
  s.extra.resize(2);
  s.trim_rad = 0.1;
  const auto text = to_toml(s);
  const auto back = load_text<Sample>("log", text);
  EXPECT_EQ(back.stiffness_N_per_m, s.stiffness_N_per_m);
  EXPECT_EQ(back.name, s.name);
  EXPECT_EQ(back.offset_mps2, s.offset_mps2);
  EXPECT_EQ(to_toml(back), text);
}

TEST(ConfigLoader, JsonHasTheSameKeysAndNullForWhatItCannotWrite) {
  Sample s;
  s.stiffness_N_per_m = std::numeric_limits<double>::quiet_NaN();
  const auto json = to_json(s);
  EXPECT_TRUE(json["stiffness_N_per_m"].is_null());
  EXPECT_EQ(json["surface"], "sand");
  EXPECT_EQ(json["motor"][1]["id"], 1);
  EXPECT_FALSE(json.contains("trim_rad"));
}

TEST(ConfigLoader, MissingKeyNamesTheLineOfItsTableAndTheLineToAdd) {
  const auto lines = problems_of("count = 3\n\n[inner]\nid = 1\n", MissingKeys::error);
  EXPECT_THAT(lines,
              ::testing::Contains("f.toml:3:1: key 'inner.mass_kg' is missing: expected a number from 0 to "
                                  "50 kg; add 'mass_kg = 1.0' (the default) to [inner]"));
  EXPECT_THAT(lines, ::testing::Contains("f.toml:1:1: key 'motor' is missing: expected an array of 2 tables "
                                         "[[motor]]"));
}

TEST(ConfigLoader, MissingTableListsItsKeys) {
  EXPECT_THAT(
      problems_of("count = 3", MissingKeys::error),
      ::testing::Contains("f.toml:1:1: key 'inner' is missing: expected a table [inner] with mass_kg, id"));
}

TEST(ConfigLoader, KeySpeltWrongIsNotCalledMissingToo) {
  auto text = to_toml(Sample{});
  text.replace(text.find("mass_kg = 1.0"), 13, "mass_g = 1000");
  EXPECT_THAT(
      problems_of(text, MissingKeys::error),
      ElementsAre(HasSubstr("'inner.mass_g' is unknown in [inner]: the unit is kg: write 'mass_kg = 1'")));
}

TEST(ConfigLoader, OptionalKeyMayBeLeftOut) {
  EXPECT_FALSE(load_text<Sample>("f.toml", to_toml(Sample{}), MissingKeys::error).trim_rad.has_value());
}

TEST(ConfigLoader, MissingKeysKeepDefaultsOnRequestEvenInsideAnArray) {
  const auto s = load_text<Sample>("f.toml", "[[motor]]\nid = 5\n[[motor]]\n", MissingKeys::use_default);
  EXPECT_EQ(s.motor[0].id, 5);
  EXPECT_EQ(s.motor[0].mass_kg, 1.0);
}

struct Broken {
  const char* what;
  const char* text;
  const char* message;
};

class ConfigMessage : public ::testing::TestWithParam<Broken> {};

TEST_P(ConfigMessage, SaysWhereWhatWasExpectedAndWhatWasFound) {
  EXPECT_THAT(problems_of(GetParam().text), ElementsAre(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Each, ConfigMessage,
    ::testing::Values(
        Broken{"unit", "[inner]\nmass_g = 550",
               "f.toml:2:1: key 'inner.mass_g' is unknown in [inner]: the unit is "
               "kg: write 'mass_kg = 0.55'"},
        Broken{
            "unit_of_stiffness", "stiffness_N_per_cm = 2.5",
            "f.toml:1:1: key 'stiffness_N_per_cm' is unknown in the top of the file: the unit is N/m: write "
            "'stiffness_N_per_m = 250'"},
        Broken{"spelling", "cuont = 3",
               "f.toml:1:1: key 'cuont' is unknown in the top of the file: did you mean "
               "'count'?"},
        Broken{"no_unit", "stiffness = 3",
               "f.toml:1:1: key 'stiffness' is unknown in the top of the file: did you "
               "mean 'stiffness_N_per_m'?"},
        Broken{"far", "[inner]\nwheels = 4",
               "f.toml:2:1: key 'inner.wheels' is unknown in [inner]: the keys here "
               "are mass_kg, id"},
        Broken{"in_array", "[[motor]]\n[[motor]]\nidd = 4",
               "f.toml:3:1: key 'motor[1].idd' is unknown in "
               "[motor[1]]: did you mean 'id'?"},
        Broken{"text_for_number", "[inner]\nmass_kg = \"1.6 kg\"",
               "f.toml:2:11: key 'inner.mass_kg' has the wrong type: expected a number from 0 to 50 kg, got "
               "the text "
               "\"1.6 kg\": write the number alone, without quotes or unit"},
        Broken{"real_for_integer", "count = 3.0",
               "f.toml:1:9: key 'count' has the wrong type: expected an integer "
               "from 1 to 9, got 3.0: write it without decimals"},
        Broken{"number_for_bool", "enabled = 1",
               "f.toml:1:11: key 'enabled' has the wrong type: expected true or "
               "false, got 1"},
        Broken{"number_for_text", "name = 1",
               "f.toml:1:8: key 'name' has the wrong type: expected text in quotes, "
               "got 1"},
        Broken{"bool_for_name", "surface = true",
               "f.toml:1:11: key 'surface' has the wrong type: expected one of "
               "\"sand\", \"wood\", \"none\", got true"},
        Broken{
            "no_such_name", "surface = \"snad\"",
            "f.toml:1:11: key 'surface' has no such value: expected one of \"sand\", \"wood\", \"none\", got "
            "\"snad\"; did you mean \"sand\"?"},
        Broken{"number_for_table", "inner = 3",
               "f.toml:1:9: key 'inner' has the wrong type: expected a table, got 3"},
        Broken{"table_for_number", "[count]",
               "f.toml:1:1: key 'count' has the wrong type: expected an integer from "
               "1 to 9, got a table"},
        Broken{"table_for_tables", "[motor]",
               "f.toml:1:1: key 'motor' has the wrong type: expected an array of 2, "
               "got a table: write the header in double brackets, [[...]]"},
        Broken{"date", "count = 1979-05-27",
               "f.toml:1:9: key 'count' has the wrong type: expected an integer from 1 "
               "to 9, got a date or time"},
        Broken{"too_large", "[inner]\nmass_kg = 550",
               "f.toml:2:11: key 'inner.mass_kg' is out of range: expected a "
               "number from 0 to 50 kg, got 550"},
        Broken{"too_small", "count = 0",
               "f.toml:1:9: key 'count' is out of range: expected an integer from 1 to 9, "
               "got 0"},
        Broken{"beyond_type", "[inner]\nid = 256",
               "f.toml:2:6: key 'inner.id' is out of range: expected an integer "
               "from 0 to 255, got 256"},
        Broken{"nan", "stiffness_N_per_m = nan",
               "f.toml:1:21: key 'stiffness_N_per_m' is not a finite number: "
               "expected a number from 0 to 100000 N/m, got nan"},
        Broken{"inf", "rates_Hz = [1, inf]",
               "f.toml:1:16: key 'rates_Hz[1]' is not a finite number: expected a number "
               "in Hz, got inf"},
        Broken{"element", "offset_mps2 = [0, 0, 9.8]",
               "f.toml:1:22: key 'offset_mps2[2]' is out of range: expected "
               "a number from -1 to 1 m/s^2, got 9.8"},
        Broken{"short_array", "offset_mps2 = [0, 0]",
               "f.toml:1:15: key 'offset_mps2' has the wrong size: expected "
               "an array of 3, got an array of 2"},
        Broken{"one_motor", "[[motor]]",
               "f.toml:1:1: key 'motor' has the wrong size: expected an array of 2, got an "
               "array of 1"},
        Broken{"rule", "[limits]\nhigh_m = 0.2\nlow_m = 0.3",
               "f.toml:3:1: key 'limits.low_m' does not fit: expected "
               "less than high_m"},
        Broken{"twice", "count = 3\ncount = 4",
               "f.toml:2:9: key 'count' is given twice: keep one of the two"},
        Broken{"no_value", "count = \n",
               "f.toml:1:9: this is not TOML: expected value, saw '\\n'; expected lines of "
               "the form 'key = value' under '[table]' headers"}),
    [](const auto& info) { return std::string(info.param.what); });

TEST(ConfigLoader, ReportsEverythingAtOnceInTheOrderOfTheFile) {
  const auto lines = problems_of("count = 0\nfoo = 1\n[inner]\nmass_kg = -1\nid = \"x\"\n");
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_THAT(lines[0], HasSubstr(":1:9: key 'count'"));
  EXPECT_THAT(lines[1], HasSubstr(":2:1: key 'foo'"));
  EXPECT_THAT(lines[2], HasSubstr(":4:11: key 'inner.mass_kg'"));
  EXPECT_THAT(lines[3], HasSubstr(":5:6: key 'inner.id'"));
}

TEST(ConfigLoader, RulesBetweenKeysWaitUntilEachKeyIsRight) {
  EXPECT_THAT(problems_of("[limits]\nlow_m = 0.3\nhigh_m = true"),
              ElementsAre(HasSubstr("'limits.high_m' has the")));
}

TEST(ConfigLoader, UnreadableFileSaysWhy) {
  try {
    load_file<Sample>("/nowhere/robot.toml");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "/nowhere/robot.toml: cannot be read (No such file or directory): check the path and its "
                 "permissions");
  }
  EXPECT_THROW(load_file<Sample>("/tmp"), ConfigError);
}

}  // namespace
}  // namespace sandhopper
