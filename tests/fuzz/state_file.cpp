// Fuzz target of the robot's kept state: the bytes as they are, and with a valid header, so that the search
// reaches the TOML behind the checksum. A state that is read must be within its ranges, must be written as it
// was read, and must never make a motor colder than ambient.
#include <fmt/format.h>
#include <zlib.h>

#include <cmath>

#include "firmware/state/kept_state.hpp"
#include "firmware/state/recollection.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

std::string with_header(std::string_view body) {
  const auto crc = ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return fmt::format("sandhopper-state 1 {} {:08x}\n{}", body.size(), crc, body);
}

void recall(const StateRead& read) {
  fuzz::require(read.state.has_value() != !read.problem.empty(), "a state or a problem");
  if (read.state) {
    const auto again = state_from_text(state_text(*read.state));
    fuzz::require(again.state && state_text(*again.state) == state_text(*read.state),
                  "is read as it was written");
  }
  static const RobotConfig robot;
  const StateClock now{"b", 1'000'000'000'000, 2'000'000'000'000, true};
  for (const auto& memory : {recollect(read, {}, now, robot), recollect({}, read, now, robot)}) {
    fuzz::require(memory.start.temperatures_known && !memory.text.empty(),
                  "every start has temperatures and a reason");
    for (std::size_t i = 0; i < kMotorCount; ++i) {
      fuzz::require(std::isfinite(memory.start.winding_C[i]) && std::isfinite(memory.start.housing_C[i]),
                    "numbers");
      fuzz::require(memory.start.winding_C[i] >= -100.0 && memory.start.winding_C[i] <= 2000.0,
                    "within reason");
    }
    fuzz::require(memory.trusted || memory.start.winding_C[0] == hot_C(robot.supervision),
                  "hot if not trusted");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of({data, size});
  recall(state_from_text(text));
  recall(state_from_text(with_header(text)));
  return 0;
}
