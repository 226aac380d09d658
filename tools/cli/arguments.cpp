#include "tools/cli/arguments.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/CLI.hpp>
#include <cstdint>

namespace sandhopper::cli {

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::show_default() {
  option_->capture_default_str();
  return *this;
}

template <class Number>
Option& Option::in_range(Number low, Number high) {
  // The text of CLI11's own message changes between its releases.
  CLI::Validator range = CLI::Range(low, high);
  range.operation([low, high](std::string& text) {
    Number value{};
    const bool within = CLI::detail::lexical_cast(text, value) && low <= value && value <= high;
    return within ? std::string() : fmt::format("Value {} not in range {} to {}", text, low, high);
  });
  option_->check(range);
  return *this;
}
template Option& Option::in_range(int, int);
template Option& Option::in_range(long, long);
template Option& Option::in_range(unsigned, unsigned);
template Option& Option::in_range(double, double);

Option& Option::non_negative() {
  option_->check(CLI::NonNegativeNumber);
  return *this;
}

Option& Option::one_of(std::vector<std::string> words) {
  option_->check(CLI::IsMember(std::move(words)));
  return *this;
}

Option& Option::existing_file() {
  option_->check(CLI::ExistingFile);
  return *this;
}

Option& Option::existing_folder() {
  option_->check(CLI::ExistingDirectory);
  return *this;
}

Option& Option::separated_by(char delimiter) {
  option_->delimiter(delimiter);
  return *this;
}

Option& Option::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option& Option::needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

bool Option::given() const { return option_->count() > 0; }

template <class Value>
Option Arguments::add_option(const std::string& name, Value& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}

Option Arguments::add_flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag(name, value, help));
}

Option Arguments::add_off_flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag_callback(
      name, [&value] { value = false; }, help));
}

Arguments Arguments::add_verb(const std::string& name, const std::string& summary) {
  return Arguments(*app_->add_subcommand(name, summary));
}

void Arguments::require_verb() { app_->require_subcommand(1); }
void Arguments::allow_one_verb() { app_->require_subcommand(0, 1); }
void Arguments::leave_the_rest() {
  app_->prefix_command();
  app_->set_help_flag();
}
bool Arguments::parsed() const { return app_->parsed(); }
void Arguments::footer(const std::string& text) { app_->footer(text); }

template Option Arguments::add_option(const std::string&, int&, const std::string&);
template Option Arguments::add_option(const std::string&, long&, const std::string&);
template Option Arguments::add_option(const std::string&, unsigned&, const std::string&);
template Option Arguments::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option Arguments::add_option(const std::string&, double&, const std::string&);
template Option Arguments::add_option(const std::string&, std::string&, const std::string&);
template Option Arguments::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option Arguments::add_option(const std::string&, std::optional<int>&, const std::string&);
template Option Arguments::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option Arguments::add_option(const std::string&, std::vector<int>&, const std::string&);
template Option Arguments::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option Arguments::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Arguments::add_option(const std::string&, std::vector<std::filesystem::path>&,
                                      const std::string&);

}  // namespace sandhopper::cli
