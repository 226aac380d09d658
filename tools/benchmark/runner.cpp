#include "tools/benchmark/runner.hpp"

#include <fmt/format.h>

#include <fstream>

#include "tools/benchmark/records.hpp"
#include "tools/conceal/follow_up.hpp"
#include "tools/conceal/write_campaign.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper::benchmark {
namespace {

namespace fs = std::filesystem;
using conceal::Json;

std::vector<std::string> command_for(const RunOptions& options, const fs::path& campaign,
                                     const fs::path& output) {
  auto command = options.tool;
  for (auto& word : command) {
    if (word == "{campaign}") word = campaign.string();
    if (word == "{output}") word = output.string();
  }
  return command;
}

// Runs the tool on one campaign, unless that is already done.
void diagnose(const RunOptions& options, const fs::path& root, const std::string& name) {
  const auto folder = root / "diagnoses";
  const auto note = folder / (name + ".run");
  if (fs::exists(note)) return;
  fs::create_directories(folder);
  const auto partial = folder / (name + ".partial");
  const auto outcome = run_limited(command_for(options, root / "campaigns" / name, folder / name), partial,
                                   folder / (name + ".log"), options.limit_s);
  fs::rename(partial, folder / (name + ".json"));
  const Json json{{"seconds", outcome.seconds}, {"exit", outcome.exit}, {"timed_out", outcome.timed_out}};
  conceal::write_text(note, json.dump() + "\n");
}

conceal::Case make(const RunOptions& options, std::uint64_t index, const std::string& name) {
  auto one = conceal::make_case(options.request, index);
  const auto answer = options.folder / "answers" / (name + ".json");
  if (fs::exists(answer)) return one;
  conceal::write_campaign(options.folder / "campaigns" / name, one);
  fs::create_directories(answer.parent_path());
  conceal::write_text(answer, conceal::answer(one, options.request, index).dump(2) + "\n");
  return one;
}

Json recommended_setup(const fs::path& diagnosis) {
  std::ifstream in(diagnosis);
  const auto json = Json::parse(in, nullptr, false);
  return json.at("next_trial").at("setup");
}

void follow_up(const RunOptions& options, const conceal::Case& one, const std::string& name) {
  const auto file = options.folder / "diagnoses" / (name + ".json");
  const auto diagnosis = read_diagnosis(file);
  if (!diagnosis || diagnosis->claims.empty() || diagnosis->claims.front().alike.empty()) return;
  const auto repeat = [&](const char* folder, const conceal::Setup& setup) {
    const auto root = options.folder / folder;
    if (!fs::exists(root / "diagnoses" / (name + ".run")))
      conceal::write_campaign(root / "campaigns" / name, one, {setup});
    diagnose(options, root, name);
  };
  if (diagnosis->asks_for_a_split) try {
      repeat("after", conceal::completed(one, recommended_setup(file)));
      // The apparatus cannot do this trial: counted as not separated.
    } catch (const std::invalid_argument& error) {
      conceal::write_text(options.folder / "diagnoses" / (name + ".refused"),
                          std::string(error.what()) + "\n");
    }
  repeat("random", conceal::random_setup(one));
}

void one_campaign(const RunOptions& options, std::uint64_t index) {
  const auto name = fmt::format("{:03d}", index);
  const auto finished = options.folder / "diagnoses" / (name + ".done");
  if (fs::exists(finished)) return;
  const auto one = make(options, index, name);
  diagnose(options, options.folder, name);
  if (options.follow_up) follow_up(options, one, name);
  conceal::write_text(finished, "");
}

}  // namespace

void run_benchmark(const RunOptions& options, const std::function<void(std::uint64_t)>& done) {
  parallel_for(
      static_cast<long>(options.campaigns), options.jobs,
      [&](long i) { one_campaign(options, static_cast<std::uint64_t>(i) + 1); },
      [&](long count, long) { done(static_cast<std::uint64_t>(count)); });
}

}  // namespace sandhopper::benchmark
