#include "firmware/log/lost_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace sandhopper {
namespace {

constexpr std::array<const char*, EnumNames<LossCause>::value.size()> kTexts{
    "the logger was too slow for {}", "{} could not be written (the disk was full or failed)",
    "{} may not have reached the disk", "{} were in an older file that was removed to keep the quota",
    "{} were in damaged parts of the file from which hop recover made this one"};

}  // namespace

void LostRecords::add(const LogGap& gap) {
  // A damaged or newer log may hold an unknown cause.
  const auto cause = std::min(static_cast<std::size_t>(gap.cause), by_cause_.size() - 1);
  by_cause_[cause] += gap.lost;
}

std::uint64_t LostRecords::total() const noexcept {
  return std::accumulate(by_cause_.begin(), by_cause_.end(), std::uint64_t{0});
}

std::string LostRecords::text() const {
  std::string text = fmt::format("{} records are missing", total());
  const char* between = ": ";
  for (std::size_t cause = 0; cause < by_cause_.size(); ++cause) {
    if (by_cause_[cause] == 0) continue;
    text += between + fmt::format(fmt::runtime(kTexts[cause]), by_cause_[cause]);
    between = "; ";
  }
  return text;
}

}  // namespace sandhopper
