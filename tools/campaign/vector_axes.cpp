#include "tools/campaign/vector_axes.hpp"

#include <algorithm>
#include <cmath>

#include "tools/campaign/column_guess.hpp"

namespace sandhopper {
namespace {

double mean_size_of(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += std::abs(value);
    ++count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

// The columns whose names have x, y and z at `place` and are else the same; empty: not all three are there.
std::vector<std::size_t> named_alike(const std::vector<std::string>& names, std::string name,
                                     std::size_t place) {
  std::vector<std::size_t> columns;
  for (const char letter : {'x', 'y', 'z'}) {
    name[place] = letter;
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return {};
    columns.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  return columns;
}

}  // namespace

VectorAxes axes_of(const CsvTable& table, std::size_t column) {
  std::vector<std::string> names;
  for (const auto& name : table.names) names.push_back(in_lower_case(name));
  const auto& name = names[column];
  VectorAxes axes;
  for (std::size_t place = 0; place < name.size() && !axes.found(); ++place) {
    if (name[place] < 'x' || name[place] > 'z') continue;
    axes.columns = named_alike(names, name, place);
    axes.taken = static_cast<std::size_t>(name[place] - 'x');
  }
  for (const auto i : axes.columns) axes.mean_size.push_back(mean_size_of(table.columns[i]));
  return axes;
}

}  // namespace sandhopper
