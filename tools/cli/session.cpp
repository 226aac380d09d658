#include "tools/cli/session.hpp"

#include <cstdio>

#include "config/directory.hpp"

namespace sandhopper::cli {

void Session::say_line(const std::string& line) {
  auto* const stream = json ? stderr : stdout;
  std::fputs((line + "\n").c_str(), stream);
  std::fflush(stream);
}

const std::filesystem::path& Session::config_directory() {
  if (config_directory_.empty()) config_directory_ = find_config_directory(config_option);
  return config_directory_;
}

}  // namespace sandhopper::cli
