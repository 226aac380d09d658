#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// Options of the command line of one verb, on top of CLI11. Its header takes seconds to compile, so only
// arguments.cpp and command_line.cpp include it.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sandhopper::cli {

// One option or positional argument. Each rule returns the option, so calls can be chained.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required();
  Option& show_default();  // shows the default value in the help text
  // Accepts values from low to high. Number: int, long, unsigned or double.
  template <class Number>
  Option& in_range(Number low, Number high);
  Option& non_negative();
  // Accepts only these words.
  Option& one_of(std::vector<std::string> words);
  Option& existing_file();
  Option& existing_folder();
  Option& separated_by(char delimiter);  // for a list
  Option& type_name(const std::string& name);
  Option& needs(const Option& other);
  Option& excludes(const Option& other);

  // True if the command line has this option.
  bool given() const;

 private:
  CLI::Option* option_;
};

// The options and sub-verbs of a verb. The variables must live until the command line has been parsed.
class Arguments {
 public:
  explicit Arguments(CLI::App& app) : app_(&app) {}

  // Value may be int, long, unsigned, std::uint64_t, double, std::string, std::filesystem::path, an optional
  // int or double, or a list of int, double, std::string or path. Another type needs an instantiation at the
  // end of arguments.cpp.
  template <class Value>
  Option add_option(const std::string& name, Value& value, const std::string& help);
  Option add_flag(const std::string& name, bool& value, const std::string& help);
  // A flag such as --no-report, which sets `value` to false.
  Option add_off_flag(const std::string& name, bool& value, const std::string& help);

  Arguments add_verb(const std::string& name, const std::string& summary);
  // The user must name one of the sub-verbs.
  void require_verb();
  // The user may name one of the sub-verbs.
  void allow_one_verb();
  void leave_the_rest();  // parses only the options common to all verbs and leaves the other words
  bool parsed() const;    // true if the command line names this verb

  // Text below the list of options in the help.
  void footer(const std::string& text);

 private:
  CLI::App* app_;
};

}  // namespace sandhopper::cli
