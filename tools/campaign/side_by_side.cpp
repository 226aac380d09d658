#include "tools/campaign/side_by_side.hpp"

#include <algorithm>
#include <map>

#include "tools/campaign/column_rivals.hpp"
#include "tools/campaign/read_table.hpp"

namespace sandhopper {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct NumberedName {
  std::string base, number;
};

// The last number outside brackets that stands alone or at the end of a word: "Run 2: Time (s)", "theta2
// (deg)", "t.1". A number within a word ("F2x") or in a unit ("m/s2") belongs to it.
NumberedName numbered(const std::string& name) {
  NumberedName found{name, ""};
  int depth = 0;
  for (std::size_t i = 0; i < name.size(); ++i) {
    depth += (name[i] == '(' || name[i] == '[') - (name[i] == ')' || name[i] == ']');
    if (depth > 0 || !is_digit(name[i])) continue;
    std::size_t end = i;
    while (end < name.size() && is_digit(name[end])) ++end;
    const bool is_in_word = end < name.size() && ((name[end] >= 'a' && name[end] <= 'z') ||
                                                  (name[end] >= 'A' && name[end] <= 'Z'));
    if (!is_in_word) {
      std::size_t begin = i;
      while (begin > 0 && (name[begin - 1] == '.' || name[begin - 1] == '_' || name[begin - 1] == ' '))
        --begin;
      found = {name.substr(0, begin) + name.substr(end), name.substr(i, end - i)};
    }
    i = end - 1;
  }
  return found;
}

}  // namespace

std::vector<SideRecording> recordings_side_by_side(const CsvTable& table) {
  std::vector<std::string> order;
  std::map<std::string, SideRecording> groups;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto name = numbered(table.names[i]);
    if (!groups.contains(name.number)) order.push_back(name.number);
    groups[name.number].push_back({i, name.base});
  }
  std::vector<SideRecording> recordings;
  for (const auto& number : order) {
    const auto& group = groups[number];
    const auto is_time = [&](const SideColumn& c) {
      const auto unit = unit_of_column(table, c.column);
      return is_called_time(c.base) || (unit && unit->is_certain && unit->dimension == "time");
    };
    if (std::ranges::count_if(group, is_time) != 1 || group.size() < 2) return {};
    const auto& first = recordings.empty() ? group : recordings.front();
    for (const auto& column : group)
      if (std::ranges::find(first, column.base, &SideColumn::base) == first.end()) return {};
    recordings.push_back(group);
  }
  return recordings.size() > 1 ? recordings : std::vector<SideRecording>{};
}

}  // namespace sandhopper
