#include "firmware/log/log_recovery.hpp"

#include "firmware/log/mcap_parts.hpp"

namespace sandhopper {

std::uint64_t LogRecovery::saved() const {
  std::uint64_t sum = 0;
  for (const auto& [name, topic] : topics) sum += topic.saved;
  return sum;
}

std::uint64_t LogRecovery::lost() const {
  std::uint64_t sum = 0;
  for (const auto& [name, topic] : topics) sum += topic.lost;
  return sum;
}

void LogRecovery::add_rest_of_file(const mcap::OneLog& log) {
  file_bytes = log.file_bytes;
  copies = log.copies;
  bytes_behind_end = log.behind;
  zeros_behind_end = log.zeros;
  for (auto& place : damage) {
    place.from_byte += log.part.from;
    place.to_byte += log.part.from;
  }
  if (cut_at) *cut_at += log.part.from;
  whole = whole && copies == 1 && bytes_behind_end == 0;
}

}  // namespace sandhopper
