// Fuzz target of CAN traffic as text. A line that is read, written and read again must be the same frame.
#include "firmware/log/candump.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

void read_line(std::string_view line) {
  try {
    const auto read = parse_candump(line);
    if (!read) return;
    fuzz::require(read->frame.length <= 8, "a frame has at most eight bytes");
    const std::string text = format_candump(read->frame, read->interface, {.decimals = 9, .direction = true});
    const auto again = parse_candump(text);
    fuzz::require(again.has_value(), "what is written can be read");
    fuzz::require(again->frame.id == read->frame.id && again->frame.length == read->frame.length &&
                      again->frame.data == read->frame.data && again->frame.time_ns == read->frame.time_ns &&
                      again->frame.direction == read->frame.direction && again->interface == read->interface,
                  "and is the same frame");
  } catch (const CandumpError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text = fuzz::text_of({data, size});
  while (!text.empty()) {
    const auto end = text.find('\n');
    read_line(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return 0;
}
