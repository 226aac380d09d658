#include <filesystem>
#include <fstream>

#include "tools/campaign/campaign.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/diagnose/campaign_input.hpp"
#include "tools/diagnose/diagnosis_json.hpp"
#include "tools/diagnose/diagnosis_text.hpp"
#include "tools/diagnose/engine.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string campaign;
  std::string output;
  bool search = false;
};

ExitCode diagnose(Session& session, const Options& options) {
  const Campaign campaign = load_campaign(options.campaign);
  const auto input = sandhopper::diagnose::read_campaign(campaign);
  for (const auto& finding : input.findings) session.say_line(to_string(finding));
  sandhopper::diagnose::EngineOptions engine;
  Progress progress("diagnosing", 1.0);
  engine.progress = [&](double share, const std::string& text) {
    progress.at(share);
    if (!text.empty()) session.say("{} (being weighed)", text);
  };
  const auto diagnosis = sandhopper::diagnose::diagnose(input.recordings, engine);
  if (options.search)
    for (const auto& line : diagnosis.log) session.say_line(line);
  const std::filesystem::path folder =
      options.output.empty() ? campaign.folder : std::filesystem::path(options.output);
  session.result = sandhopper::diagnose::to_json(diagnosis);
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  std::ofstream answer(folder / "diagnosis.json");
  if (!(answer << session.result.dump(2) << "\n"))
    throw Failure(ExitCode::fault, fmt::format("{} cannot be written", (folder / "diagnosis.json").string()),
                  "name a folder that can be written with --output");
  if (!diagnosis.corrected_model_toml.empty())
    std::ofstream(folder / "corrected.toml") << diagnosis.corrected_model_toml;
  session.say_line(sandhopper::diagnose::to_text(diagnosis));
  session.say("verdict: {} ({})", diagnosis.verdict, diagnosis.detail);
  return ExitCode::ok;
}

Run set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("CAMPAIGN", options->campaign, "folder with campaign.toml")->required();
  app.add_option("--output", options->output, "folder for the answer; default: the campaign's own");
  app.add_flag("--search", options->search, "also print what was tried");
  return [options](Session& session) { return diagnose(session, *options); };
}

const VerbRegistration kDiagnose({"diagnose", "find the physics that a simulation lacks against recordings",
                                  set_up});

}  // namespace
}  // namespace sandhopper::cli
