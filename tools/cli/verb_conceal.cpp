#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "config/program.hpp"
#include "tools/benchmark/runner.hpp"
#include "tools/benchmark/score_study.hpp"
#include "tools/cli/output_folder.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/conceal/follow_up.hpp"
#include "tools/conceal/write_campaign.hpp"

namespace sandhopper::cli {
namespace {

namespace fs = std::filesystem;
constexpr const char* kListCure = "'hop conceal --list' names what there is";

struct Options {
  std::string output;
  std::uint64_t campaigns = 12;
  std::uint64_t seed = 1;
  std::string plant, kind, effect;
  double size = 0.0;
  int trials = 12;
  bool list = false;

  std::string campaign, setup;     // of the sub-verb follow-up
  std::string answers, diagnoses;  // of the sub-verb score
  std::string report;
  std::vector<std::string> baselines;
  double limit_s = 30.0;  // of the sub-verb benchmark
  unsigned jobs = 2;
  bool no_follow_up = false;
  std::string tool;
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

// Checks the request before anything is written.
void check_request(const conceal::Request& request) {
  try {
    conceal::check(request);
  } catch (const std::invalid_argument& error) {
    throw Failure(ExitCode::usage, error.what(), kListCure);
  }
}

ExitCode list(Session& session) {
  for (const auto* plant : conceal::plants()) {
    auto& of_plant = session.result[plant->name()];
    session.say("{}", plant->name());
    for (const auto& effect : plant->listed()) {
      of_plant["listed"].push_back(effect.id);
      session.say("  {}", effect.id);
    }
    for (const auto& effect : plant->unlisted()) {
      of_plant["unlisted"].push_back({{"id", effect.id}, {"port", effect.port}});
      session.say("  {} (outside the list, port {})", effect.id, effect.port);
    }
  }
  return ExitCode::ok;
}

ExitCode generate(Session& session, const Options& options) {
  if (options.list) return list(session);
  if (options.output.empty())
    throw Failure(ExitCode::usage, "no place to write to", "name a new folder with --output");
  const fs::path root = options.output;
  if (fs::exists(root / "campaigns"))
    throw Failure(ExitCode::usage, root.string() + " already holds campaigns",
                  "name a new folder with --output");
  const auto request = request_of(options);
  check_request(request);
  made(root);
  Progress progress("concealing", static_cast<double>(options.campaigns));
  for (std::uint64_t i = 1; i <= options.campaigns; ++i) {
    const auto name = fmt::format("{:03d}", i);
    try {
      const auto one = conceal::make_case(request, i);
      conceal::write_campaign(root / "campaigns" / name, one);
      fs::create_directories(root / "answers");
      conceal::write_text(root / "answers" / (name + ".json"),
                          conceal::answer(one, request, i).dump(2) + "\n");
    } catch (const std::invalid_argument& error) {
      throw Failure(ExitCode::usage, error.what(), kListCure);
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

conceal::Json read_json(const fs::path& file) {
  std::ifstream in(file);
  auto json = conceal::Json::parse(in, nullptr, false);
  if (json.is_discarded() || !json.is_object())
    throw Failure(ExitCode::usage, file.string() + " is not a JSON object", "name another file");
  return json;
}

// Writes the campaign again with one more trial, the one that was asked for.
ExitCode follow_up(Session& session, const Options& options) {
  const auto folder = fs::weakly_canonical(options.campaign);
  const auto answer =
      (options.answers.empty() ? folder.parent_path().parent_path() / "answers" : fs::path(options.answers)) /
      (folder.filename().string() + ".json");
  if (!fs::exists(answer))
    throw Failure(ExitCode::usage, "no answer at " + answer.string(),
                  "name the folder of the answers with --answers");
  auto asked = read_json(options.setup);
  if (asked.contains("next_trial")) asked = asked["next_trial"].value("setup", conceal::Json::object());
  const auto sealed = read_json(answer);
  try {
    const auto one =
        conceal::make_case(conceal::Request::from_json(sealed.at("request")), sealed.at("index"));
    conceal::write_campaign(options.output, one, {conceal::completed(one, asked)});
    session.say("{}: the campaign with trial {:03d} added", options.output, one.setups.size() + 1);
    session.result = {{"campaign", options.output}, {"trial", one.setups.size() + 1}};
  } catch (const std::invalid_argument& error) {
    throw Failure(ExitCode::usage, error.what(),
                  "tools/conceal/README.md lists the trials each plant can do");
  }
  return ExitCode::ok;
}

std::vector<std::pair<std::string, fs::path>> named_folders(const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, fs::path>> folders;
  for (const auto& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || !fs::is_directory(text.substr(equals + 1)))
      throw Failure(ExitCode::usage, "--baseline " + text + " is not NAME=FOLDER",
                    "name a folder of diagnoses NNN.json");
    folders.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return folders;
}

ExitCode score(Session& session, const Options& options) {
  std::vector<benchmark::Truth> truths;
  try {
    truths = benchmark::read_truths(options.answers);
  } catch (const std::runtime_error& error) {
    throw Failure(ExitCode::usage, error.what(), "name the folder answers/ that 'hop conceal' wrote");
  }
  if (truths.empty())
    throw Failure(ExitCode::usage, "no answers in " + options.answers, "name the folder answers/");
  const fs::path diagnoses = options.diagnoses;
  const auto columns = benchmark::score_all(truths, diagnoses, named_folders(options.baselines));
  const auto splits = benchmark::split_figures(truths, diagnoses);
  const auto seconds = benchmark::seconds_taken(truths, diagnoses);
  for (const auto& line : benchmark::score_text(columns, splits, seconds)) session.say("{}", line);
  bool met = true;
  for (const auto& column : columns) session.result["tools"][column.name] = benchmark::to_json(column.score);
  for (const auto& figure : columns.front().score.figures) met = met && (figure.of == 0 || figure.met());
  const auto& where = columns.front().score.localisation;
  met = met && (where.campaigns == 0 || where.met());
  for (const auto& split : splits) session.result["splits"].push_back(benchmark::to_json(split));
  if (!options.report.empty()) {
    write_study_page(benchmark::score_study(columns, splits, seconds), options.report);
    session.say("page: {}", options.report);
  }
  return met ? ExitCode::ok : ExitCode::no;
}

ExitCode run_and_score(Session& session, Options options) {
  if (options.output.empty())
    throw Failure(ExitCode::usage, "no place to write to", "name a folder with --output");
  benchmark::RunOptions run;
  run.folder = options.output;
  run.request = request_of(options);
  check_request(run.request);
  made(run.folder);
  run.campaigns = options.campaigns;
  run.limit_s = options.limit_s;
  run.jobs = options.jobs;
  run.follow_up = !options.no_follow_up;
  if (options.tool.empty()) {
    find_program("hop-diagnose");  // fail now, not in every campaign
    run.tool = {find_program("hop").string(), "diagnose", "{campaign}", "--json", "--output", "{output}"};
  } else {
    std::istringstream words(options.tool);
    for (std::string word; words >> word;) run.tool.push_back(word);
  }
  {
    Progress progress("diagnosing", static_cast<double>(run.campaigns));
    try {
      benchmark::run_benchmark(run, [&](std::uint64_t count) { progress.at(static_cast<double>(count)); });
    } catch (const std::invalid_argument& error) {
      throw Failure(ExitCode::usage, error.what(), kListCure);
    }
  }
  options.answers = (run.folder / "answers").string();
  options.diagnoses = (run.folder / "diagnoses").string();
  options.report = (run.folder / "score.html").string();
  const auto exit = score(session, options);
  conceal::write_text(run.folder / "score.json", session.result.dump(2) + "\n");
  return exit;
}

void add_request_options(Arguments& arguments, Options& o) {
  arguments.add_option("--output", o.output, "folder to make; campaigns/ and answers/ go into it");
  arguments.add_option("--campaigns", o.campaigns, "how many").in_range(1, 100000).show_default();
  arguments.add_option("--seed", o.seed, "the same seed gives the same campaigns").show_default();
  arguments.add_option("--plant", o.plant, "hopper, intruder, falling_body or rotary_axis; default: any");
  arguments.add_option("--kind", o.kind, "what is hidden; default: a mixture")
      .one_of({"null", "decoy", "single", "several", "unknown", "indistinguishable"});
  arguments.add_option("--effect", o.effect, "hide this one; --list names them");
  arguments.add_option("--size", o.size, "of what is hidden, relative to typical; default: 0.1 to 3")
      .in_range(0.001, 100.0);
  arguments.add_option("--trials", o.trials, "of a campaign").in_range(1, 500).show_default();
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  auto& o = *options;
  arguments.allow_one_verb();
  add_request_options(arguments, o);
  arguments.add_flag("--list", o.list, "name plants and effects, write nothing");

  auto following = arguments.add_verb("follow-up", "the campaign again with one trial more");
  following.add_option("CAMPAIGN", o.campaign, "a campaign's folder").required().existing_folder();
  following.add_option("SETUP", o.setup, "JSON: the trial's set-up, or a diagnosis whose next_trial is meant")
      .required()
      .existing_file();
  following.add_option("--answers", o.answers, "folder of the answers; default: beside the campaigns");
  following.add_option("--output", o.output, "folder of the new campaign").required();

  auto scoring = arguments.add_verb("score", "hold diagnoses against the answers");
  scoring.add_option("ANSWERS", o.answers, "folder of NNN.json by 'hop conceal'").required();
  scoring.add_option("DIAGNOSES", o.diagnoses, "folder of NNN.json by 'hop diagnose --json'")
      .required()
      .existing_folder();
  scoring.add_option("--baseline", o.baselines, "NAME=FOLDER: another tool's diagnoses, beside it");
  scoring.add_option("--report", o.report, "page to write");

  auto running = arguments.add_verb("benchmark", "conceal, diagnose and score; goes on where it was stopped");
  add_request_options(running, o);
  running.add_option("--jobs", o.jobs, "diagnoses at a time").in_range(1, 64).show_default();
  running.add_option("--limit-s", o.limit_s, "time for one diagnosis").in_range(0.1, 86400.0).show_default();
  running.add_flag("--no-follow-up", o.no_follow_up, "do not add the trials the tool recommends");
  running.add_option("--tool", o.tool,
                     "command that prints diagnosis.json; {campaign} and {output} stand for folders");
  running.add_option("--baseline", o.baselines, "NAME=FOLDER: another tool's diagnoses, beside it");

  return [=](Session& session) {
    if (following.parsed()) return follow_up(session, *options);
    if (scoring.parsed()) return score(session, *options);
    if (running.parsed()) return run_and_score(session, *options);
    return generate(session, *options);
  };
}

const VerbRegistration kConceal("conceal", set_up);

}  // namespace
}  // namespace sandhopper::cli
