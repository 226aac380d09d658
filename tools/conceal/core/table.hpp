#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace sandhopper::conceal {

struct Column {
  std::string name;
  int decimals;
  std::vector<double> values;  // NaN: no sample, written as an empty cell
};

// One recording: rows in time, columns named as in tools/docs/guide/recordings.md.
struct Table {
  std::vector<Column> columns;

  Column& add(std::string name, int decimals);
  Column* find(const std::string& name);
  const Column* find(const std::string& name) const;
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  void keep_rows(const std::vector<bool>& kept);
};

// The table as CSV; every number of a column has the same number of decimals.
std::string to_csv(const Table& table);

}  // namespace sandhopper::conceal
