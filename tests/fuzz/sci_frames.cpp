// Fuzz target of drivers/tof: bytes of the serial line to the time-of-flight sensor's companion.
#include <algorithm>
#include <cmath>

#include "drivers/tof/afbr_s50.hpp"
#include "drivers/tof/sci_protocol.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

void require_round_trip(const SciFrame& frame) {
  const std::vector<std::uint8_t> payload(frame.payload.begin(), frame.payload.end());
  SciParser parser;
  bool came = false;
  for (const std::uint8_t byte : sci_encode(frame.command, payload, frame.address)) {
    const auto again = parser.feed(byte);
    if (!again) continue;
    came = true;
    fuzz::require(
        again->command == frame.command && again->address == frame.address &&
            std::equal(again->payload.begin(), again->payload.end(), payload.begin(), payload.end()),
        "a frame encoded again is the same");
  }
  fuzz::require(came && parser.broken_frames() == 0, "what is encoded can be read");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  SciParser parser;
  // The raw bytes, and the bytes as one frame with a valid CRC, which a random search seldom finds.
  std::vector<std::uint8_t> stream(data, data + size);
  if (size > 1 && size < 400) {
    const auto framed = sci_encode(static_cast<SciCommand>(data[0] & ~kSciAddressed), {data + 1, size - 1});
    stream.insert(stream.end(), framed.begin(), framed.end());
  }
  for (const std::uint8_t byte : stream) {
    const auto frame = parser.feed(byte);
    if (!frame) continue;
    fuzz::require(frame->payload.size() <= 512, "a frame is no longer than the parser's memory");
    if (const auto measured = decode_measurement_1d(*frame)) {
      fuzz::require(std::isfinite(measured->range_m) && std::isfinite(measured->amplitude),
                    "a distance is a number");
      const TofSample sample = to_sample(*measured, TofConfig{}, 0);
      fuzz::require(std::isnan(sample.height_m) || std::isfinite(sample.height_m),
                    "a height is a number or unset");
    }
    decode_answer(*frame);
    require_round_trip(*frame);
  }
  return 0;
}
