#include "tools/cli/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/hint.hpp"
#include "firmware/version.hpp"
namespace sandhopper::cli {
namespace {

constexpr const char* kAbout =
    "Firmware and tools of a one-legged hopper that feels the ground: run hops, replay and look at their "
    "logs.";
constexpr const char* kFooter =
    "Every verb takes --json (one JSON object on standard output, the text on standard error) and --config "
    "DIR.\n"
    "Exit status: 0 done, 1 the answer is no, 2 command line or configuration wrong, 3 hardware or system "
    "fault.\n"
    "'hop VERB --help' explains a verb.";

void add_common_options(CLI::App& app, Session& session) {
  app.add_flag("--json", session.json, "one JSON object on standard output, text on standard error")
      ->group("Every verb");
  app.add_option("--config", session.config_option,
                 "directory of the TOML files; default $SANDHOPPER_CONFIG, the source tree's, "
                 "/etc/sandhopper")
      ->type_name("DIR")
      ->group("Every verb");
}

// A verb accepts the options of the verb above it. Unknown words are left to not_expected(), which suggests
// the nearest known word.
void let_options_through(CLI::App& app) {
  app.allow_extras();
  for (auto* sub : app.get_subcommands({})) {
    sub->fallthrough();
    let_options_through(*sub);
  }
}

std::vector<std::string> verbs_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

}  // namespace

CommandLine::CommandLine(Session& session, const std::vector<Verb>& verbs) : app_(kAbout, "hop") {
  app_.set_version_flag("--version", "hop " + std::string(kVersion), "print the version");
  app_.footer(kFooter);
  app_.get_formatter()->label("SUBCOMMAND", "VERB");
  add_common_options(app_, session);
  for (const auto& verb : verbs) {
    auto* sub = app_.add_subcommand(verb.name, verb.summary);
    sub->group("Verbs");
    add_common_options(*sub, session);
    Arguments arguments(*sub);
    verbs_.emplace_back(sub, verb.set_up(arguments));
    let_options_through(*sub);
  }
  app_.allow_extras();
}

Run CommandLine::parse(int argc, char** argv) {
  try {
    app_.parse(argc, argv);
  } catch (const CLI::CallForVersion& version) {
    throw Help{version.what()};
  } catch (const CLI::Success&) {
    throw Help{app_.help()};
  } catch (const CLI::Error& error) {
    throw explain(error);
  }
  for (const auto& [sub, run] : verbs_)
    if (sub->parsed() && sub->get_prefix_command()) return run;
  if (const auto words = app_.remaining(true); !words.empty()) throw not_expected(words.front());
  for (const auto& [sub, run] : verbs_)
    if (sub->parsed()) return run;
  throw Failure(ExitCode::usage, "no verb given", "choose one of those 'hop --help' lists");
}

const CLI::App& CommandLine::deepest() const {
  const CLI::App* app = &app_;
  while (true) {
    const auto parsed = app->get_subcommands();
    if (parsed.empty()) return *app;
    app = parsed.front();
  }
}

std::string CommandLine::understood() const {
  std::string name = "hop";
  for (const CLI::App* app = &app_; !app->get_subcommands().empty(); name += " " + app->get_name())
    app = app->get_subcommands().front();
  return name;
}

std::vector<std::string> CommandLine::known_options() const {
  std::vector<std::string> names;
  for (const CLI::App* app = &deepest(); app; app = app->get_parent())
    for (const auto* option : app->get_options())
      for (const auto& name : option->get_lnames())
        if (std::find(names.begin(), names.end(), "--" + name) == names.end()) names.push_back("--" + name);
  return names;
}

std::string CommandLine::meaning_of_option_in(const std::string& message) const {
  const CLI::Option* named = nullptr;
  for (const CLI::App* app = &deepest(); app; app = app->get_parent())
    for (const auto* option : app->get_options()) {
      const auto name = option->get_name();
      const bool longer = !named || name.size() > named->get_name().size();
      if (longer && message.find(name) != std::string::npos) named = option;
    }
  return named ? fmt::format("{}: {}", named->get_name(), named->get_description()) : "";
}

Failure CommandLine::not_expected(const std::string& word) const {
  const auto see = fmt::format("'{} --help' shows what there is", understood());
  if (word.starts_with("-")) {
    const auto near = nearest_words(word.substr(0, word.find('=')), known_options());
    return {ExitCode::usage, fmt::format("unknown option '{}'", word),
            near.empty() ? see : fmt::format("did you mean {}? {}", either(near), see)};
  }
  const auto verbs = verbs_of(deepest());
  if (verbs.empty()) return {ExitCode::usage, fmt::format("'{}' is one argument too many", word), see};
  const auto near = nearest_words(word, verbs);
  return {ExitCode::usage, fmt::format("unknown verb '{}'", word),
          near.empty() ? fmt::format("the verbs are {}", fmt::join(verbs, ", "))
                       : fmt::format("did you mean {}?", either(near))};
}

Failure CommandLine::explain(const CLI::Error& error) const {
  // The parser often reports a misspelt word as a missing one, so report the unknown word first.
  if (const auto words = app_.remaining(true); !words.empty()) return not_expected(words.front());
  const auto see = fmt::format("'{} --help' shows what it takes", understood());
  const auto verbs = verbs_of(deepest());
  if (!verbs.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError))
    return {ExitCode::usage, fmt::format("needs one of: {}", fmt::join(verbs, ", ")), see};
  const auto meaning = meaning_of_option_in(error.what());
  return {ExitCode::usage, error.what(), meaning.empty() ? see : fmt::format("{}; {}", meaning, see)};
}

}  // namespace sandhopper::cli
