#include "tools/campaign/cell_cures.hpp"

#include <algorithm>
#include <string_view>

#include "tools/campaign/cell_forms.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kNotANumber = "\" is not a number";

bool is_plain_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789.,") == std::string_view::npos &&
         text.find_first_of("0123456789") != std::string_view::npos;
}

// Lengths of the groups between commas, behind a sign and before a decimal point: {1, 2, 3} for -1,00,000.5.
std::vector<std::size_t> groups_of(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  text = text.substr(0, text.find('.'));
  std::vector<std::size_t> lengths{0};
  for (const char c : text) {
    if (c == ',')
      lengths.push_back(0);
    else if (c >= '0' && c <= '9')
      ++lengths.back();
    else
      return {};
  }
  return lengths;
}

bool are_groups(const std::vector<std::size_t>& lengths, std::size_t inner) {
  return lengths.size() > 1 && lengths.front() > 0 && lengths.front() <= inner && lengths.back() == 3 &&
         std::all_of(lengths.begin() + 1, lengths.end() - 1, [&](std::size_t n) { return n == inner; });
}

bool is_decimal_comma(std::string_view cell) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  return is_plain_number(cell) && std::ranges::count(cell, ',') == 1 &&
         cell.find('.') == std::string_view::npos;
}

std::string cure_for_text(std::string_view cell, char separator) {
  if (cell.ends_with('-') && is_plain_number(cell.substr(0, cell.size() - 1))) cell.remove_suffix(1);
  if (cell.starts_with('(') && cell.ends_with(')') && is_plain_number(cell.substr(1, cell.size() - 2)))
    return "if brackets mean a negative number, as in accounting, format the cells as plain numbers, -0.16, "
           "before saving";
  const auto groups = groups_of(cell);
  if (groups.size() > 2 && !are_groups(groups, 3) && are_groups(groups, 2))
    return "if the digits are grouped in the Indian way, 1,00,000 for 100000, write the numbers without "
           "commas "
           "between digits";
  if (are_groups(groups, 3))
    // Decimal commas in quotes between commas would have been found by the rows above.
    return separator == ',' || groups.size() > 2 || cell.find('.') != std::string_view::npos
               ? "if the comma divides thousands write [format] thousands = \",\" into campaign.toml"
               : "if the comma divides thousands write [format] thousands = \",\" into campaign.toml, if it "
                 "is a "
                 "decimal comma decimal = \",\"";
  if (is_decimal_comma(cell))
    return "if that is a decimal comma write [format] decimal = \",\" into campaign.toml";
  if (const auto form = form_of_cell(cell)) return "that is " + form->name + ": " + form->cure;
  return "";
}

}  // namespace

std::string cure_for_cells(const CsvIssue& issue, char separator) {
  const auto end = issue.text.rfind(kNotANumber);
  if (issue.fault == CsvFault::not_a_number && end != std::string::npos && end > 1) {
    auto cure = cure_for_text(std::string_view(issue.text).substr(1, end - 1), separator);
    if (!cure.empty()) return cure;
  }
  return std::string(cure_for(issue.fault));
}

}  // namespace sandhopper
