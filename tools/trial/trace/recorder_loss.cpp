#include "tools/trial/trace/recorder_loss.hpp"

#include <charconv>
#include <regex>
#include <string>

namespace sandhopper::trace {
namespace {

constexpr const char* kLoss = R"((drop(s|ped)?|lost|lose|discard(s|ed)?|miss(ed|ing)|over(run|flow)(s|ed)?))";
constexpr const char* kThing = R"((frames?|messages?|msgs?|packets?|datagrams?|buffers?|fifo|queue|socket))";

std::optional<std::uint64_t> number_in(const std::string& text, const std::regex& form) {
  std::smatch found;
  if (!std::regex_search(text, found, form)) return std::nullopt;
  const std::string digits = found[1];
  std::uint64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

}  // namespace

std::optional<RecorderLoss> loss_said_in(std::string_view line) {
  constexpr auto kForm = std::regex::icase | std::regex::ECMAScript;
  static const std::regex loss("\\b" + std::string(kLoss) + "\\b", kForm);
  static const std::regex thing("\\b" + std::string(kThing) + "\\b", kForm);
  // "311 CAN frames", then "dropped 311", "dropped: 311", "lost = 311".
  static const std::regex in_front("\\b([0-9]+)\\s+(?:[A-Za-z]+\\s+)?" + std::string(kThing) + "\\b", kForm);
  static const std::regex behind(
      "\\b" + std::string("(?:drop(?:s|ped)?|lost|discarded|missed|overruns?|overflows?)") +
          "\\s*[:=]?\\s*([0-9]+)\\b",
      kForm);
  constexpr std::size_t kLongestLine = 512;  // text of a recorder, not the rest of another file
  const std::string text(line.substr(0, kLongestLine));
  if (!std::regex_search(text, loss) || !std::regex_search(text, thing)) return std::nullopt;
  auto frames = number_in(text, in_front);
  if (!frames) frames = number_in(text, behind);
  if (frames && *frames == 0) return std::nullopt;
  if (!frames && text.starts_with('#')) return std::nullopt;
  return RecorderLoss{frames.value_or(0)};
}

}  // namespace sandhopper::trace
