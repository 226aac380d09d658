#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "tools/conceal/case.hpp"
#include "tools/conceal/write_campaign.hpp"

namespace sandhopper::conceal {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// The content of all files of a folder, in the order of their paths.
std::string all_text(const fs::path& folder) {
  std::set<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.insert(entry.path());
  std::string text;
  for (const auto& file : files) text += fs::relative(file, folder).string() + "\n" + text_of(file);
  return text;
}

fs::path written(const Request& request, std::uint64_t index, const std::string& name) {
  const auto folder = fs::path(testing::TempDir()) / ("conceal_" + name);
  fs::remove_all(folder);
  write_campaign(folder, make_case(request, index));
  return folder;
}

Request request_for(const std::string& plant, std::optional<Kind> kind) {
  Request r;
  r.seed = 11;
  r.plant = plant;
  r.kind = kind;
  r.trials = 3;
  return r;
}

class EachPlant : public testing::TestWithParam<std::string> {};

TEST_P(EachPlant, SameSeedGivesTheSameBytes) {
  const auto request = request_for(GetParam(), Kind::single);
  const auto first = all_text(written(request, 4, GetParam() + "_a"));
  EXPECT_EQ(first, all_text(written(request, 4, GetParam() + "_b")));
  EXPECT_NE(first, all_text(written(request, 5, GetParam() + "_c")));
}

TEST_P(EachPlant, EveryEffectActsAtTypicalSizeAndNothingActsAtNone) {
  auto request = request_for(GetParam(), std::nullopt);
  request.size = 1.0;
  request.trials = GetParam() == "hopper" ? 1 : 3;  // one hop contains several touchdowns
  const auto* plant = find_plant(GetParam());
  auto effects = plant->listed();
  for (const auto& effect : plant->unlisted()) effects.push_back(effect);
  for (const auto& effect : effects) {
    request.effect = effect.id;
    const auto hidden = make_case(request, 1);
    const auto plain = build(hidden, {});
    bool differs = false;
    for (std::size_t i = 0; i < hidden.setups.size(); ++i) {
      const auto& setup = hidden.setups[i];
      const auto trial = hidden.recording.stream("trial", i);
      const auto without = to_csv(record(hidden, *plain, setup, trial));
      differs = differs || to_csv(record(hidden, *hidden.bench, setup, trial)) != without;
      EXPECT_EQ(to_csv(record(hidden, *plain, setup, trial)), without);
    }
    EXPECT_TRUE(differs) << effect.id;
  }
}

// The form of a file must not reveal what is hidden: header, number of decimals, rows, names, keys and belief
// must be those of the same apparatus with nothing hidden.
TEST_P(EachPlant, FilesLookTheSameWhateverIsHidden) {
  for (const auto kind : {Kind::single, Kind::several, Kind::unknown}) {
    const auto hidden = make_case(request_for(GetParam(), kind), 3);
    const auto plain = build(hidden, {});
    EXPECT_EQ(to_toml(hidden.bench->belief()), to_toml(plain->belief()));
    for (std::size_t i = 0; i < hidden.setups.size(); ++i) {
      const auto trial = hidden.recording.stream("trial", i);
      const auto with = record(hidden, *hidden.bench, hidden.setups[i], trial);
      const auto without = record(hidden, *plain, hidden.setups[i], trial);
      ASSERT_EQ(with.columns.size(), without.columns.size());
      for (std::size_t c = 0; c < with.columns.size(); ++c) {
        EXPECT_EQ(with.columns[c].name, without.columns[c].name);
        EXPECT_EQ(with.columns[c].decimals, without.columns[c].decimals);
      }
      // A fall may last longer if an effect slows it. All other trials are recorded for a fixed time.
      if (GetParam() != "falling_body") {
        EXPECT_EQ(with.columns.front().values, without.columns.front().values);
      }
    }
  }
}

TEST_P(EachPlant, NoWordOfTheAnswerStandsInTheCampaign) {
  const auto request = request_for(GetParam(), Kind::unknown);
  const auto hidden = make_case(request, 2);
  const auto folder = written(request, 2, GetParam() + "_words");
  const auto campaign = text_of(folder / "campaign.toml") + text_of(folder / "nominal.toml");
  EXPECT_THAT(campaign, testing::Not(testing::HasSubstr(hidden.hidden.front().info.id)));
  for (const auto kind : {"unknown", "single", "several", "decoy", "hidden", "effect", "seed"})
    EXPECT_THAT(campaign, testing::Not(testing::HasSubstr(kind)));
  for (const auto& entry : fs::directory_iterator(folder / "trials"))
    EXPECT_TRUE(std::regex_match(entry.path().filename().string(), std::regex("[0-9]{3}\\.csv")));
}

INSTANTIATE_TEST_SUITE_P(All, EachPlant, testing::Values("falling_body", "hopper", "intruder", "rotary_axis"),
                         [](const auto& info) { return info.param; });

TEST(Conceal, KindsComeInTheirSharesAndInNoFixedOrder) {
  Request request;
  request.plant = "falling_body";
  request.trials = 2;
  std::map<Kind, int> count;
  std::vector<Kind> first, second;
  for (std::uint64_t i = 0; i < 32; ++i) {
    const auto kind = make_case(request, i).kind;
    ++count[kind];
    (i < 16 ? first : second).push_back(kind);
  }
  EXPECT_EQ(count[Kind::null], 6);
  EXPECT_EQ(count[Kind::decoy], 2);
  EXPECT_EQ(count[Kind::single], 12);
  for (const auto kind : {Kind::several, Kind::unknown, Kind::indistinguishable}) EXPECT_EQ(count[kind], 4);
  EXPECT_NE(first, second);
}

TEST(Conceal, AnswerMakesTheSameCampaignAgain) {
  const auto request = request_for("intruder", std::nullopt);
  const auto json = answer(make_case(request, 6), request, 6);
  const auto again = make_case(Request::from_json(json.at("request")), json.at("index").get<std::uint64_t>());
  EXPECT_EQ(json, answer(again, request, 6));
}

TEST(Conceal, SizeIsLogUniformOverTheRange) {
  auto request = request_for("falling_body", Kind::single);
  int small = 0, large = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const double size = make_case(request, i).hidden.front().size;
    ASSERT_GE(size, 0.1);
    ASSERT_LE(size, 3.0);
    small += size < 0.3;
    large += size > 1.0;
  }
  EXPECT_NEAR(small, 32, 15);
  EXPECT_NEAR(large, 32, 15);
}

TEST(Conceal, UnknownWordsAreRefused) {
  EXPECT_THROW(make_case(request_for("submarine", std::nullopt), 1), std::invalid_argument);
  auto request = request_for("intruder", std::nullopt);
  request.effect = "rail.coulomb";
  EXPECT_THROW(make_case(request, 1), std::invalid_argument);
}

}  // namespace
}  // namespace sandhopper::conceal
