// Fuzz target of the configuration files of robot, devices and world. A file that is accepted is written and
// read again. A file that is rejected must come with problems that name their place.
#include "config/load.hpp"
#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tools/plant/world_config.hpp"

namespace {

using namespace sandhopper;

template <class Config>
void read(std::string_view text, MissingKeys missing) {
  try {
    const auto config = load_text<Config>("input.toml", text, missing);
    const std::string written = to_toml(to_node(config));
    const auto again = load_text<Config>("written.toml", written);
    fuzz::require(to_toml(to_node(again)) == written, "what is written is read as it was");
  } catch (const ConfigError& error) {
    fuzz::require(!error.problems().empty(), "an error names a problem");
    for (const auto& problem : error.problems())
      fuzz::require(problem.file != "written.toml", "what is written can be read");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of({data, size});
  read<RobotConfig>(text, MissingKeys::use_default);
  read<RobotConfig>(text, MissingKeys::error);
  read<LinuxBoardConfig>(text, MissingKeys::use_default);
  read<WorldConfig>(text, MissingKeys::use_default);
  return 0;
}
