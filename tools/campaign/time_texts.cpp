#include "tools/campaign/time_texts.hpp"

#include <charconv>

namespace sandhopper {
namespace {

bool reads(std::string_view text, std::uint64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

// Empty for a text that is no such pair of counts; a fraction that begins with 0 is padded.
std::optional<TimeTexts::Parts> TimeTexts::parts_of(std::string_view text, char decimal) {
  const auto mark = text.find(decimal);
  if (mark == std::string_view::npos) return std::nullopt;
  const auto fraction = text.substr(mark + 1);
  if (fraction.size() > 1 && fraction.starts_with('0')) return std::nullopt;
  Parts parts;
  if (!reads(text.substr(0, mark), parts.whole) || !reads(fraction, parts.fraction)) return std::nullopt;
  return parts;
}

void TimeTexts::take(const TextRow& row) {
  if (row.is_remark || (!may_be_counted_ && !may_be_sorted_)) return;
  const auto text = text_of_column(row, table_, column_);
  const auto style = table_.layout.numbers;
  const auto now = number_in_cell(text, style);
  if (!now) return;
  const auto parts = parts_of(text, style.decimal);
  may_be_counted_ &= parts.has_value();
  if (!last_.empty()) {
    const auto before = parts_of(last_, style.decimal);
    may_be_counted_ &= before && parts && *before <= *parts;
    may_be_sorted_ &= last_ <= text;
    if (*now < *number_in_cell(last_, style) && first_back_.line == 0)
      first_back_ = {{}, row.line, last_, std::string(text)};
  }
  last_ = text;
}

std::optional<TimeTextDoubt> TimeTexts::doubt() const {
  if (first_back_.line == 0 || (!may_be_counted_ && !may_be_sorted_)) return std::nullopt;
  auto doubt = first_back_;
  doubt.kind = may_be_counted_ ? TimeTextDoubt::Kind::counted_fraction : TimeTextDoubt::Kind::sorted_as_text;
  return doubt;
}

}  // namespace sandhopper
