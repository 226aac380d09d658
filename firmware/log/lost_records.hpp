#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "firmware/log/topics.hpp"

namespace sandhopper {

// Missing records of a log by cause, from its gap records.
class LostRecords {
 public:
  void add(const LogGap& gap);
  std::uint64_t total() const noexcept;
  // Sentence with the causes: "7 records are missing: the logger was too slow for 5; …".
  std::string text() const;

 private:
  std::array<std::uint64_t, EnumNames<LossCause>::value.size()> by_cause_{};
};

}  // namespace sandhopper
