#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/campaign.hpp"
#include "tools/cli/diagnose_effects.hpp"
#include "tools/cli/output_folder.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"
#include "tools/diagnose/answer/diagnosis_json.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/answer/page/diagnosis_page.hpp"
#include "tools/diagnose/answer/residuals_csv.hpp"
#include "tools/diagnose/answer/spread_text.hpp"
#include "tools/diagnose/discrepancy/port_error_evidence.hpp"
#include "tools/diagnose/evidence/form_error_evidence.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"
#include "tools/diagnose/rounded_belief.hpp"
#include "tools/report/digits.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string campaign;
  std::string output;
  bool effects = false;
  bool search = false;
  bool residuals = false;
  bool report = true;
  double limit_s = std::numeric_limits<double>::infinity();
  std::vector<double> port_errors;
  std::vector<double> form_errors;
  std::string form_error_effect;
};

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  if (!(out << text).flush())
    throw Failure(ExitCode::fault, file.string() + " cannot be written",
                  "name a folder that can be written with --output");
}

// corrected.toml, or corrected_2.toml and so on if the former is the model file that the campaign used.
std::filesystem::path corrected_file(const std::filesystem::path& folder,
                                     const std::filesystem::path& believed) {
  std::error_code missing;
  auto file = folder / "corrected.toml";
  for (int i = 2; std::filesystem::equivalent(file, believed, missing); ++i)
    file = folder / fmt::format("corrected_{}.toml", i);
  return file;
}

// The answer that wrote the model in use: diagnosis.json beside it, if that names this model as its own.
// Empty if there is none.
std::optional<sandhopper::diagnose::FirstAnswer> first_answer(const std::filesystem::path& model) {
  const auto file = model.parent_path() / "diagnosis.json";
  const auto json = nlohmann::json::parse(std::ifstream(file), nullptr, false);
  if (!json.is_object() || json.value("corrected_model", nlohmann::json()) != model.filename().string())
    return {};
  sandhopper::diagnose::FirstAnswer first{file.string(), {}};
  for (const auto& fit : json.value("fit_by_channel", nlohmann::json::array()))
    first.error[fit.at("channel")] = fit.at("heldout").at("beyond_floor").at("before");
  return first;
}

std::vector<sandhopper::diagnose::BelievedNumber> believed(const UsedNumbers& used) {
  std::vector<sandhopper::diagnose::BelievedNumber> numbers;
  for (const auto& n : used.numbers)
    numbers.push_back({n.key, n.low, n.high, n.unit, n.source_text, usual_error(n), 0.0});
  return numbers;
}

// Lists the model's numbers that the diagnosis relies on, their sources, and those whose usual error matters.
// Defaults of [sensors] and [spread] stand in one line.
void tell_belief(Session& session, const UsedNumbers& used,
                 const std::vector<sandhopper::diagnose::BelievedNumber>& numbers) {
  for (const auto& number : used.numbers) {
    if (!is_listed(number)) continue;
    const auto found = std::ranges::find(numbers, number.key, &sandhopper::diagnose::BelievedNumber::key);
    std::string shows;
    if (found != numbers.end() && std::isfinite(found->error_that_shows) && found->error_that_shows > 0.0)
      shows = fmt::format(
          "; an error of {} would show{}", plain_number(found->error_that_shows, 2),
          found->matters() ? fmt::format(", and {} is usual: it matters", plain_number(found->usual_error, 2))
                           : "");
    if (found != numbers.end() && found->known_sd > 0.0)
      shows += fmt::format("; known to {}, and beside what was found these recordings ask for {}",
                           plain_number(found->known_sd, 2), signed_number(found->asked_for, 2));
    session.say("belief {}{}", to_string(number), shows);
  }
  if (const auto defaults = defaults_of_sensors(used); !defaults.empty()) session.say("belief {}", defaults);
  session.say("belief {} more numbers are 0 by default: their physics is off", used.off);
}

// Default spreads between trials that the plant uses because none is stated.
void tell_assumed_spreads(Session& session, const sandhopper::diagnose::Diagnosis& d) {
  for (const auto& n : d.trial_to_trial)
    if (n.is_default && std::ranges::find(d.belief, "spread." + n.name,
                                          &sandhopper::diagnose::BelievedNumber::key) == d.belief.end())
      session.say("belief spread.{} = {} (default, not stated: each trial may differ by that much)", n.name,
                  sandhopper::diagnose::amount_in_words(n, n.believed_sd));
}

// No trial could be read, so there is no diagnosis; the findings give the reasons.
ExitCode tell_nothing_usable(Session& session, const std::filesystem::path& folder, std::size_t trials) {
  sandhopper::diagnose::Diagnosis nothing;
  nothing.notes.push_back(
      fmt::format("none of {} trials can be used: correct the errors listed above", trials));
  session.result = sandhopper::diagnose::to_json(nothing);
  write(folder / "diagnosis.json", session.result.dump(2) + "\n");
  session.say("no verdict: {}", nothing.notes.front());
  return ExitCode::no;
}

// Prints the log evidence of a campaign in which nothing is missing, for each size of the port error.
ExitCode tell_port_errors(Session& session, const sandhopper::diagnose::Recordings& recordings,
                          const std::vector<double>& sizes, Progress& progress) {
  const auto evidence = sandhopper::diagnose::port_error_evidence(
      recordings, sizes, [&](double share) { progress.at(share, "fitting the belief as it is"); });
  session.result["port_error_evidence"] = nlohmann::json::array();
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    session.say("port error {}: log evidence {:.1f}", sizes[i], evidence[i]);
    session.result["port_error_evidence"].push_back(
        {{"port_error", sizes[i]}, {"log_evidence", evidence[i]}});
  }
  return ExitCode::ok;
}

// Prints the log evidence of a campaign in which one listed effect is missing, for each share of the form
// error.
ExitCode tell_form_errors(Session& session, const sandhopper::diagnose::Recordings& recordings,
                          const Options& options, Progress& progress) {
  if (options.form_error_effect.empty())
    throw Failure(ExitCode::usage, "--form-errors needs the effect that is missing",
                  "add --effect NAME; --effects lists their names");
  const auto known = sandhopper::diagnose::known_effects();
  if (std::ranges::find(known, options.form_error_effect, &sandhopper::diagnose::Effect::id) == known.end())
    throw Failure(ExitCode::usage, fmt::format("\"{}\" is no listed effect", options.form_error_effect),
                  "--effects lists their names");
  const auto evidence = sandhopper::diagnose::form_error_evidence(
      recordings, options.form_error_effect, options.form_errors,
      [&](double share) { progress.at(share, "fitting the effect"); });
  session.result["form_error_evidence"] = nlohmann::json::array();
  if (evidence.empty())
    session.say(
        "{}: no log evidence. It is not possible in this campaign, has no law (a reading), or the fit failed",
        options.form_error_effect);
  for (std::size_t i = 0; i < evidence.size(); ++i) {
    session.say("form error, share {}: log evidence {:.1f}", options.form_errors[i], evidence[i]);
    session.result["form_error_evidence"].push_back(
        {{"share", options.form_errors[i]}, {"log_evidence", evidence[i]}});
  }
  return evidence.empty() ? ExitCode::no : ExitCode::ok;
}

ExitCode diagnose(Session& session, const Options& options) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const Campaign campaign = load_campaign(options.campaign);
  Progress progress("diagnosing", 1.0);
  progress.at(0.0, "reading the recordings");
  const auto input = sandhopper::diagnose::read_campaign(campaign);
  for (const auto& line : in_lines(input.findings, false)) session.say_line(line);
  if (options.effects && !input.recordings.trials.empty()) return list_effects(session, input.recordings);
  const std::filesystem::path folder =
      options.output.empty() ? campaign.folder : std::filesystem::path(options.output);
  made(folder);  // before the work, so that a folder that cannot be made is reported at once
  if (input.recordings.trials.empty()) return tell_nothing_usable(session, folder, campaign.trials.size());
  if (!options.port_errors.empty())
    return tell_port_errors(session, input.recordings, options.port_errors, progress);
  if (!options.form_errors.empty()) return tell_form_errors(session, input.recordings, options, progress);
  sandhopper::diagnose::EngineOptions engine;
  engine.tell_evidence = options.search;
  const auto used = used_numbers(campaign);
  engine.belief = believed(used);
  engine.progress = [&](double share, const char* step) { progress.at(share, step); };
  engine.first_verdict = [&](const std::string& verdict) {
    session.say("first verdict: {} (preliminary)", verdict);
  };
  engine.stop = [&] { return std::chrono::duration<double>(Clock::now() - start).count() > options.limit_s; };
  const auto first = first_answer(campaign.model);  // before this answer may overwrite it
  auto diagnosis =
      sandhopper::diagnose::diagnose_as_written(input.recordings, engine, rounding_of(used, campaign));
  diagnosis.first = first;
  const auto corrected = corrected_file(folder, campaign.model);
  if (!diagnosis.corrected_model_toml.empty()) diagnosis.corrected_model_file = corrected.filename().string();
  if (options.search)
    for (const auto& line : diagnosis.log) session.say_line(line);
  session.result = sandhopper::diagnose::to_json(diagnosis);
  write(folder / "diagnosis.json", session.result.dump(2) + "\n");
  session.say_line(sandhopper::diagnose::to_text(diagnosis));
  tell_belief(session, used, diagnosis.belief);
  for (const auto& effect : stated_effects(campaign)) session.say("belief {}", effect);
  tell_assumed_spreads(session, diagnosis);
  if (!diagnosis.corrected_model_toml.empty()) {
    write(corrected, diagnosis.corrected_model_toml);
    session.say("corrected model: {}", corrected.string());
  }
  if (options.residuals) {
    write(folder / "residuals.csv", sandhopper::diagnose::residuals_csv(diagnosis));
    session.say(
        "residuals: {}{}", (folder / "residuals.csv").string(),
        diagnosis.residuals.empty() ? " (no row: no trial could be compared with the simulation)" : "");
  }
  session.say("answer: {}", (folder / "diagnosis.json").string());
  if (options.report) {
    const auto page = folder / "diagnosis.html";
    sandhopper::diagnose::PageFacts facts{campaign.name, std::string(name_of(campaign.plant)), {}};
    facts.findings = in_lines(input.findings, false);
    sandhopper::diagnose::write_diagnosis_page(diagnosis, facts, page);
    session.say("page: {}", page.string());
  }
  return diagnosis.verdict == sandhopper::diagnose::Verdict::insufficient_time ? ExitCode::no : ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("CAMPAIGN", options->campaign, "folder with campaign.toml").required();
  arguments.add_option("--output", options->output, "folder for the answer; default: the campaign's own");
  arguments.add_off_flag("--no-report", options->report, "write no page");
  arguments
      .add_option("--limit-s", options->limit_s,
                  "end the search after this many seconds, at the end of the fit in progress, and answer "
                  "with what is known")
      .in_range(0.0, 1e9);
  arguments.add_flag("--effects", options->effects,
                     "no diagnosis: list the effects that would be looked for, with equation, parameters, "
                     "units and their typical sizes in this campaign");
  arguments.add_flag("--search", options->search, "also print what was tried");
  arguments.add_flag("--residuals", options->residuals,
                     "also write residuals.csv: recorded minus simulated, before and after, of every row");
  arguments
      .add_option("--port-errors", options->port_errors,
                  "no diagnosis: how well these sizes of the model error at the ports, in shares of each "
                  "port's scale, explain a campaign in which nothing is missing")
      .separated_by(',')
      .in_range(0.0, 10.0);
  arguments
      .add_option("--form-errors", options->form_errors,
                  "no diagnosis: how well these shares of the assumed error in the form of a law explain a "
                  "campaign in which only the effect named by --effect is missing")
      .separated_by(',')
      .in_range(1e-3, 100.0);
  arguments.add_option("--effect", options->form_error_effect,
                       "effect for --form-errors, e.g. terrain.added_mass");
  return [options](Session& session) { return diagnose(session, *options); };
}

const VerbRegistration kDiagnose("diagnose", set_up);

}  // namespace
}  // namespace sandhopper::cli
