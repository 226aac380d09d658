#pragma once
#include <CLI/App.hpp>
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/cli/verb.hpp"

namespace sandhopper::cli {

// The parser of `hop` and of its verbs' programs: each verb with its options, and messages that name the
// cure.
class CommandLine {
 public:
  CommandLine(Session& session, const std::vector<Verb>& verbs);

  // What to run. Throws Failure(usage) for a wrong command line, Help when help or the version was asked for.
  struct Help {
    std::string text;
  };
  Run parse(int argc, char** argv);

  // "hop", "hop trial" or "hop config check": as far as the command line was understood.
  std::string understood() const;

 private:
  const CLI::App& deepest() const;
  Failure explain(const CLI::Error& error) const;
  Failure not_expected(const std::string& word) const;
  std::vector<std::string> known_options() const;
  std::string meaning_of_option_in(const std::string& message) const;

  CLI::App app_;
  std::vector<std::pair<CLI::App*, Run>> verbs_;
};

}  // namespace sandhopper::cli
