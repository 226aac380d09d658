#include "tools/trial/trace/spreadsheet.hpp"

namespace sandhopper::trace {
namespace {

std::size_t digits_at(std::string_view text, std::size_t place) {
  const auto end = text.find_first_not_of("0123456789", place);
  return (end == std::string_view::npos ? text.size() : end) - place;
}

}  // namespace

bool has_spreadsheet_number(std::string_view line) {
  const auto mark = line.find('#');
  if (mark == std::string_view::npos) return false;
  const auto data = line.substr(mark + 1);
  if (digits_at(data, 0) != 1 || data.size() < 2) return false;
  std::size_t place = 1;
  if (data[place] == '.' || data[place] == ',') place += 1 + digits_at(data, place + 1);
  if (place + 2 >= data.size() || (data[place] != 'E' && data[place] != 'e')) return false;
  return (data[place + 1] == '+' || data[place + 1] == '-') && digits_at(data, place + 2) > 0;
}

}  // namespace sandhopper::trace
