#pragma once
#include <CLI/App.hpp>
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/cli/verb.hpp"

namespace sandhopper::cli {

// Parser of `hop` and of the verbs' programs. Error messages tell the user what to do.
class CommandLine {
 public:
  CommandLine(Session& session, const std::vector<Verb>& verbs);

  // Returns the function to run. Throws Failure(usage) for a wrong command line, Help if help or the version
  // was asked for.
  struct Help {
    std::string text;
  };
  Run parse(int argc, char** argv);

  // The verbs parsed so far: "hop", "hop trial" or "hop config check".
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
