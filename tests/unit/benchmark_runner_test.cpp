#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tools/benchmark/runner.hpp"
#include "tools/benchmark/score_files.hpp"

namespace sandhopper::benchmark {
namespace {

namespace fs = std::filesystem;

class BenchmarkRunner : public testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder); }
  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }

  // A tool as a short shell script; `calls` counts its calls.
  RunOptions options(const std::string& script) {
    const auto file = folder / "tool.sh";
    std::ofstream(file) << "echo \"$1\" >> '" << (folder / "calls").string() << "'\n" << script << "\n";
    RunOptions o;
    o.folder = folder / "run";
    o.campaigns = 3;
    o.request.plant = "falling_body";
    o.request.trials = 2;
    o.jobs = 2;
    o.tool = {"sh", file.string(), "{campaign}"};
    return o;
  }

  int calls() const {
    std::ifstream in(folder / "calls");
    int count = 0;
    for (std::string line; std::getline(in, line);) ++count;
    return count;
  }

  const fs::path folder = fs::path(testing::TempDir()) / ("benchmark_runner_" + std::to_string(::getpid()));
};

TEST_F(BenchmarkRunner, GoesOnWhereItWasStopped) {
  const auto o = options("echo '{\"verdict\": \"consistent\", \"effects\": []}'");
  run_benchmark(o, [](std::uint64_t) {});
  EXPECT_EQ(calls(), 3);
  fs::remove(o.folder / "diagnoses" / "002.run");  // as if it had been killed there
  fs::remove(o.folder / "diagnoses" / "002.done");
  run_benchmark(o, [](std::uint64_t) {});
  EXPECT_EQ(calls(), 4);
  const auto truths = read_truths(o.folder / "answers");
  EXPECT_EQ(truths.size(), 3u);
  EXPECT_EQ(read_diagnosis(o.folder / "diagnoses" / "002.json")->verdict, "consistent");
  EXPECT_EQ(seconds_taken(truths, o.folder / "diagnoses").size(), 3u);
}

TEST_F(BenchmarkRunner, ToolThatHangsIsKilledAndCountsAsNoAnswer) {
  auto o = options("sleep 60");
  o.campaigns = 1;
  o.limit_s = 0.3;
  const auto begin = std::chrono::steady_clock::now();
  run_benchmark(o, [](std::uint64_t) {});
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  EXPECT_FALSE(read_diagnosis(o.folder / "diagnoses" / "001.json"));
}

TEST_F(BenchmarkRunner, AddsTheTrialTheToolAskedForWhereItNamedAClass) {
  auto o = options(
      "echo '{\"verdict\": \"missing_physics\", \"effects\": [{\"id\": \"body.mass\", \"probability\": 0.5,"
      "\"indistinguishable_from\": [\"fluid.buoyancy\"]}],"
      "\"next_trial\": {\"setup\": {\"kind\": \"drop\", \"release_height_m\": 3.25}}}'");
  o.campaigns = 1;
  run_benchmark(o, [](std::uint64_t) {});
  std::ifstream in(o.folder / "after" / "campaigns" / "001" / "campaign.toml");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(text.find("trials/003.csv"), std::string::npos);
  EXPECT_NE(text.find("release_height_m = 3.25"), std::string::npos);
  EXPECT_TRUE(fs::exists(o.folder / "after" / "diagnoses" / "001.json"));
  EXPECT_TRUE(fs::exists(o.folder / "random" / "diagnoses" / "001.json"));
  EXPECT_EQ(calls(), 3);
}

// A tool that names the mass alone after a trial was added. If it recommended no trial to split the class,
// only the random trial is done, which then shows that some trial splits it.
TEST_F(BenchmarkRunner, CountsATrialAsSplittingOnlyWhereItWasRecommendedForThat) {
  const std::string effect =
      "{\"verdict\": \"missing_physics\", \"effects\": [{\"id\": \"body.mass\", "
      "\"probability\": 0.9, \"indistinguishable_from\": [";
  for (const std::string purpose : {"split", "repeat"}) {
    auto o = options("case \"$1\" in *after*|*random*) echo '" + effect + "]}]}' ;; *) echo '" + effect +
                     "\"fluid.buoyancy\"]}], \"next_trial\": {\"purpose\": \"" + purpose +
                     "\", \"setup\": {\"kind\": \"drop\", \"release_height_m\": 3.25}}}' ;; esac");
    o.folder = folder / purpose;
    o.campaigns = 1;
    o.request.kind = conceal::kind_named("single");
    o.request.effect = "body.mass";
    run_benchmark(o, [](std::uint64_t) {});
    const auto truths = read_truths(o.folder / "answers");
    const auto figures = split_figures(truths, o.folder / "diagnoses");
    ASSERT_EQ(figures.size(), 3u);
    const std::size_t asked = purpose == "split";
    EXPECT_EQ(fs::exists(o.folder / "after"), purpose == "split");
    for (const std::size_t i : {0u, 1u}) {
      EXPECT_EQ(figures[i].of, asked);
      EXPECT_EQ(figures[i].count, asked);
    }
    EXPECT_EQ(figures[2].of, 1 - asked);
    EXPECT_EQ(figures[2].count, 1 - asked);
  }
}

// The apparatus cannot weigh or tap, so a set-up that holds no more than a kind asks for no trial.
TEST_F(BenchmarkRunner, ATestOnTheBenchIsNoTrialThatItCouldSimulate) {
  const auto asks = [&](const std::string& setup) {
    std::ofstream(folder / "bench.json") << "{\"verdict\": \"missing_physics\", \"next_trial\": "
                                            "{\"purpose\": \"split\", \"setup\": "
                                         << setup << "}}";
    return read_diagnosis(folder / "bench.json")->asks_for_a_split;
  };
  EXPECT_FALSE(asks("{}"));
  EXPECT_FALSE(asks("{\"kind\": \"tap\"}"));
  EXPECT_TRUE(asks("{\"kind\": \"drop\", \"release_height_m\": 2.0}"));
}

// Suction acts on the foot's way up only (tests/conceal/cells_test.cpp).
TEST_F(BenchmarkRunner, ScoresTheCellsThatTheToolReports) {
  auto o = options(
      "echo '{\"verdict\": \"missing_physics\", \"effects\": [], \"where\": ["
      "{\"channel\": \"force_N\", \"phase\": \"unloading\"},"
      "{\"channel\": \"force_N\", \"phase\": \"hold\"}, {\"channel\": \"force_N\"}, "
      "{\"channel\": \"force_N\", \"phase\": null}, 7]}'");
  o.campaigns = 1;
  o.request.plant = "intruder";
  o.request.effect = "terrain.suction";
  o.request.size = 1.0;
  run_benchmark(o, [](std::uint64_t) {});
  const auto columns = score_all(read_truths(o.folder / "answers"), o.folder / "diagnoses", {});
  const auto& found = columns.front().score.localisation;
  EXPECT_EQ(found.campaigns, 1u);
  EXPECT_EQ(found.true_positives, 1u);
  EXPECT_EQ(found.false_positives, 1u);
  EXPECT_EQ(found.missed, 0u);
}

}  // namespace
}  // namespace sandhopper::benchmark
