#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "tools/report/base64.hpp"
#include "tools/report/envelope.hpp"
#include "tools/report/ground_text.hpp"
#include "tools/report/report_json.hpp"
#include "tools/report/trial_page.hpp"

namespace sandhopper {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Report, Base64AgreesWithTheStandardsOwnVectors) {
  const auto encoded = [](std::string_view text) { return base64(std::as_bytes(std::span(text))); };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

// 1000 s at 1 kHz with one stride from 500.0 s to 500.4 s and a single outlier at 700.5 s.
ReportData long_trial() {
  ReportData data;
  data.columns.push_back({"load_cell_force_N", {}});
  for (int row = 0; row < 1'000'000; ++row) {
    data.time_s.push_back(row * 1e-3);
    data.columns[0].values.push_back(row % 7 == 0 ? std::nan("") : 1.0);
  }
  data.columns[0].values[700'500] = 42.0;
  ReportStride stride;
  stride.touchdown_s = 500.0;
  stride.liftoff_s = 500.4;
  data.strides.push_back(stride);
  return data;
}

TEST(Report, LongTrialIsThinnedButItsStridesAndExtremesStay) {
  std::size_t run = 0;
  const ReportData thinned = envelope(long_trial(), {}, run);
  EXPECT_GT(run, 1u);
  EXPECT_LE(thinned.time_s.size(), 61'000u);
  EXPECT_TRUE(std::ranges::is_sorted(thinned.time_s));
  EXPECT_EQ(thinned.columns[0].values.size(), thinned.time_s.size());
  EXPECT_THAT(thinned.columns[0].values, testing::Contains(42.0));
  const auto in_stride =
      std::ranges::count_if(thinned.time_s, [](double t) { return t >= 500.0 && t < 500.4; });
  EXPECT_EQ(in_stride, 400);
}

TEST(Report, ShortTrialIsShownRowByRow) {
  ReportData data = long_trial();
  data.time_s.resize(50'000);
  data.columns[0].values.resize(50'000);
  std::size_t run = 0;
  EXPECT_EQ(envelope(data, {}, run).time_s, data.time_s);
  EXPECT_EQ(run, 1u);
}

TEST(Report, TextOfALogCannotBecomePartOfThePage) {
  ReportData data;
  data.title = "<b>bold</b>";
  data.notes = {"</script><script>alert(1)</script>"};
  const std::string page = trial_page(data);
  EXPECT_THAT(page, HasSubstr("<title>&lt;b>bold&lt;/b></title>"));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
}

TEST(Report, PageNamesNoAddressToLoadFrom) {
  const std::string page = trial_page(ReportData{});
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  EXPECT_THAT(page, Not(HasSubstr("<link")));
  EXPECT_THAT(page, Not(HasSubstr("sourceMappingURL")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(Report, WhatAStanceFoundInTheGroundIsAnEventOfThePage) {
  ReportData data;
  data.events = {{0.1, 1, "touchdown", "leg_rate", ""}, {0.6, 2, "touchdown", "leg_rate", ""}};
  ReportStride stride{.number = 1, .liftoff_s = 0.4};
  stride.ground_events.rupture = {GroundEventKind::crust_rupture, 0.0123, 14.2, 0.45, 3.1, 0.4, 20.0, 13.7};
  data.strides = {stride};
  const auto events = report_json(data, 1).at("events");
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[1].at("name"), "ground");
  EXPECT_EQ(events[1].at("values"), "a crust broke at 12.3 mm: 14.2 N at 0.45 m/s, size 3.1 +- 0.4 N");
}

TEST(Report, SizeOfAnEventHasNoMoreDigitsThanItsError) {
  const GroundEvent layer{GroundEventKind::layer_boundary, 0.0195, 41.4, 0.55, 2217.4, 298.2, 20.0, 13.7};
  EXPECT_THAT(in_words(layer), HasSubstr("size 2217 +- 298 N/m"));
  const GroundEvent pull{GroundEventKind::suction, 0.0195, 41.4, 0.55, 2.174, 0.042, 20.0, 13.7};
  EXPECT_THAT(in_words(pull), HasSubstr("size 2.17 +- 0.04 N"));
}

TEST(Report, UnwritablePlaceIsNamed) {
  EXPECT_THAT([] { write_trial_report({}, "no/such/folder/report.html"); },
              testing::ThrowsMessage<std::runtime_error>(HasSubstr("no/such/folder/report.html")));
}

}  // namespace
}  // namespace sandhopper
