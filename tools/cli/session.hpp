#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/failure.hpp"

namespace sandhopper::cli {

// Environment of a verb: output, and the directory of the configuration.
//
// Text for people goes to standard output. With --json it goes to standard error, and `result` is printed to
// standard output when the verb ends.
class Session {
 public:
  template <class... Args>
  // Prints a line for people.
  void say(fmt::format_string<Args...> text, Args&&... args) {
    say_line(fmt::format(text, std::forward<Args>(args)...));
  }
  void say_line(const std::string& line);

  // The directory by the rules of config/directory.hpp; determined at the first call.
  const std::filesystem::path& config_directory();
  // Path of a file in the configuration directory.
  std::string config_file(const std::string& name) { return (config_directory() / name).string(); }

  bool json = false;
  std::string config_option;
  nlohmann::ordered_json result = nlohmann::ordered_json::object();

 private:
  std::filesystem::path config_directory_;
};

}  // namespace sandhopper::cli
