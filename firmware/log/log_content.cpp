#include "firmware/log/log_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <span>

#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper {

bool is_mcap(const std::filesystem::path& file) {
  std::array<char, mcap::kMagic.size()> begin{};
  std::ifstream in(file, std::ios::binary);
  return in.read(begin.data(), begin.size()) &&
         std::ranges::equal(std::as_bytes(std::span(begin)), mcap::kMagic);
}

LogContent content_of_log(const std::filesystem::path& file) {
  mcap::Reader log(file, {.check_crc = true, .skip_damaged = true});
  std::map<std::uint16_t, std::uint64_t> messages;
  for (mcap::Message message; log.next(message);) ++messages[message.channel->number];
  LogContent out;
  for (const auto& [number, channel] : log.channels()) {
    const bool cdr = channel.message_encoding == "cdr";
    out.has_cycles |= cdr && channel.topic == topic::kOutput && messages[number] > 0;
    out.is_of_this_firmware |= cdr && (channel.topic == topic::kFrame || channel.topic == topic::kOutput);
    if (messages[number] == 0) continue;
    out.topics +=
        fmt::format("{}{} ({} messages)", out.topics.empty() ? "" : ", ", channel.topic, messages[number]);
  }
  return out;
}

}  // namespace sandhopper
