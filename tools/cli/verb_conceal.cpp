#include <fmt/format.h>

#include <filesystem>

#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/conceal/write_campaign.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string output;
  std::uint64_t campaigns = 12;
  std::uint64_t seed = 1;
  std::string plant, kind, effect;
  double size = 0.0;
  int trials = 12;
  bool list = false;
};

conceal::Request request_of(const Options& options) {
  conceal::Request request;
  request.seed = options.seed;
  request.plant = options.plant;
  request.effect = options.effect;
  request.trials = options.trials;
  if (!options.kind.empty()) request.kind = conceal::kind_named(options.kind);
  if (options.size > 0.0) request.size = options.size;
  return request;
}

ExitCode list(Session& session) {
  for (const auto* plant : conceal::plants()) {
    auto& of_plant = session.result[plant->name()];
    for (const auto& effect : plant->listed()) of_plant["listed"].push_back(effect.id);
    for (const auto& effect : plant->unlisted()) of_plant["unlisted"].push_back(effect.id);
    session.say("{}", plant->name());
    for (const auto& effect : plant->listed()) session.say("  {}", effect.id);
    for (const auto& effect : plant->unlisted())
      session.say("  {} (outside the list, port {})", effect.id, effect.port);
  }
  return ExitCode::ok;
}

ExitCode generate(Session& session, const Options& options) {
  if (options.list) return list(session);
  if (options.output.empty())
    throw Failure(ExitCode::usage, "no place to write to", "name a new folder with --output");
  const std::filesystem::path root = options.output;
  if (std::filesystem::exists(root / "campaigns"))
    throw Failure(ExitCode::usage, root.string() + " already holds campaigns",
                  "name a new folder with --output");
  const auto request = request_of(options);
  Progress progress("concealing", static_cast<double>(options.campaigns));
  for (std::uint64_t i = 1; i <= options.campaigns; ++i) {
    const auto name = fmt::format("{:03d}", i);
    try {
      const auto one = conceal::make_case(request, i);
      conceal::write_campaign(root / "campaigns" / name, one);
      std::filesystem::create_directories(root / "answers");
      conceal::write_text(root / "answers" / (name + ".json"),
                          conceal::answer(one, request, i).dump(2) + "\n");
    } catch (const std::invalid_argument& error) {
      throw Failure(ExitCode::usage, error.what(), "'hop conceal --list' names what there is");
    }
    progress.at(static_cast<double>(i));
  }
  session.say("{} campaigns in {}, their answers in {}", options.campaigns, (root / "campaigns").string(),
              (root / "answers").string());
  session.result = {{"campaigns", (root / "campaigns").string()},
                    {"answers", (root / "answers").string()},
                    {"count", options.campaigns}};
  return ExitCode::ok;
}

Run set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("--output", options->output, "folder to make; campaigns/ and answers/ go into it");
  app.add_option("--campaigns", options->campaigns, "how many")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--seed", options->seed, "the same seed gives the same campaigns")->capture_default_str();
  app.add_option("--plant", options->plant, "hopper, intruder, falling_body or rotary_axis; default: any");
  app.add_option("--kind", options->kind, "what is hidden; default: a mixture")
      ->check(CLI::IsMember({"null", "decoy", "single", "several", "unknown", "indistinguishable"}));
  app.add_option("--effect", options->effect, "hide this one; --list names them");
  app.add_option("--size", options->size, "of what is hidden, relative to typical; default: 0.1 to 3")
      ->check(CLI::Range(0.001, 100.0));
  app.add_option("--trials", options->trials, "of a campaign")
      ->check(CLI::Range(1, 500))
      ->capture_default_str();
  app.add_flag("--list", options->list, "name plants and effects, write nothing");
  return [options](Session& session) { return generate(session, *options); };
}

const VerbRegistration kConceal({"conceal",
                                 "make campaigns in which physics is hidden, to test 'hop diagnose'",
                                 set_up});

}  // namespace
}  // namespace sandhopper::cli
