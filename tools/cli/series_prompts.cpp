#include "tools/cli/series_prompts.hpp"

#include <unistd.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <iostream>

#include "config/load.hpp"
#include "tools/cli/failure.hpp"

namespace sandhopper::cli {
namespace {

// Reads one line of answer; returns false at the end of the input.
bool ask(const std::string& question, std::string& answer) {
  std::cout << question << std::flush;
  if (!std::getline(std::cin, answer)) return false;
  const auto first = answer.find_first_not_of(" \t");
  answer =
      first == std::string::npos ? "" : answer.substr(first, answer.find_last_not_of(" \t\r") - first + 1);
  return true;
}

std::optional<double> number_in(const std::string& text, double low, double high) {
  double value = 0.0;
  const auto* end = text.data() + text.size();
  if (std::from_chars(text.data(), end, value).ptr != end || !(value >= low && value <= high))
    return std::nullopt;
  return value;
}

bool is_quit(const std::string& answer) { return answer == "q" || answer == "Q"; }

// Returns false on q and at the end of the input.
bool ask_text(const std::string& question, std::string& value) {
  while (value.empty())
    if (!ask(question, value) || is_quit(value)) return false;
  return true;
}

// Asks in millimetres, the unit of a ruler. Enter keeps the known value. Returns false on q and at the end of
// the input.
bool ask_height(TrialSheet& sheet) {
  while (true) {
    std::string answer;
    const auto known = sheet.release_height_m;
    const auto question =
        known ? fmt::format("  release height of the sole over the bed, mm [{:g}]: ", 1e3 * *known)
              : std::string("  release height of the sole over the bed, mm: ");
    if (!ask(question, answer) || is_quit(answer)) return false;
    if (answer.empty() && known) return true;
    if (const auto height_mm = number_in(answer, 0.5, 1000.0)) {
      sheet.release_height_m = *height_mm * 1e-3;
      return true;
    }
    std::cout << "  a number from 0.5 to 1000, in millimetres, without its unit; q ends the series\n";
  }
}

bool ask_for_missing(TrialSheet& sheet) {
  std::cout << "Trial sheet; it goes into every log of the series. q ends.\n";
  return ask_text("  who runs the trials: ", sheet.who) &&
         ask_text("  bed (material, grain size): ", sheet.bed) &&
         ask_text("  how the bed is prepared before each trial: ", sheet.bed_preparation) &&
         (sheet.release_height_m || ask_height(sheet));
}

bool asked_for(const TrialOptions& o) {
  return o.series > 0 || !o.sheet.empty() || !o.who.empty() || !o.bed.empty() || !o.bed_preparation.empty() ||
         !o.notes.empty() || o.payload_kg >= 0.0;
}

std::string option_of(const std::string& key) {
  std::string option = "--" + key;
  for (char& c : option)
    if (c == '_') c = '-';
  return option;
}

}  // namespace

bool can_ask(const Session& session) {
  return !session.json && ::isatty(STDIN_FILENO) != 0 && ::isatty(STDOUT_FILENO) != 0;
}

std::optional<TrialSheet> gather_sheet(Session& session, const TrialOptions& options) {
  if (!asked_for(options)) return std::nullopt;
  TrialSheet sheet;
  if (!options.sheet.empty()) sheet = load_file<TrialSheet>(options.sheet, MissingKeys::use_default);
  const auto given = [](const std::string& from, std::string& to) {
    if (!from.empty()) to = from;
  };
  given(options.who, sheet.who);
  given(options.bed, sheet.bed);
  given(options.bed_preparation, sheet.bed_preparation);
  given(options.notes, sheet.notes);
  if (options.payload_kg >= 0.0) sheet.payload_kg = options.payload_kg;
  if (options.release_height_given) sheet.release_height_m = options.release_height_m;
  auto missing = missing_keys(sheet);
  if (!missing.empty() && can_ask(session)) {
    if (!ask_for_missing(sheet))
      throw Failure(ExitCode::no, "ended at the trial sheet: nothing was started",
                    "answer its questions, or give a file with them with --sheet");
    missing = missing_keys(sheet);
  }
  if (missing.empty()) return sheet;
  std::string keys, options_text;
  for (const auto& key : missing) {
    keys += (keys.empty() ? "" : ", ") + key;
    options_text += (options_text.empty() ? "" : ", ") + option_of(key);
  }
  throw Failure(ExitCode::usage, "the trial sheet lacks " + keys,
                "give " + options_text + ", or a file with these keys with --sheet");
}

bool prepare_next(Session& session, int number, int trials, TrialSheet& sheet) {
  session.say("\nTrial {} of {}. Before it:", number + 1, trials);
  session.say("  1. lift the robot into the catch, clean the foot");
  session.say("  2. prepare the bed: {}", sheet.bed_preparation);
  session.say("  3. move the foot over ground that no trial has touched since");
  session.say("  4. nobody within the robot's reach, e-stop released and at hand");
  if (!ask_height(sheet)) return false;
  sheet.notes.clear();
  if (!ask("  notes on this trial [none]: ", sheet.notes) || is_quit(sheet.notes)) return false;
  std::string go;
  return ask("  Enter when all is ready, q ends the series: ", go) && !is_quit(go);
}

}  // namespace sandhopper::cli
