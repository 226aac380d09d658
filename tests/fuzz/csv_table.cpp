// Fuzz target of recordings as CSV, with all options of the reader.
#include <cmath>
#include <sstream>

#include "firmware/log/csv_import.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

void read(const std::string& text, const CsvReadOptions& options) {
  std::istringstream in(text);
  const CsvTable table = read_csv(in, options);
  fuzz::require(table.names.size() == table.columns.size(), "a column has a name");
  fuzz::require(table.issues.size() <= options.max_issues, "no more issues are listed than asked for");
  for (const auto& column : table.columns) {
    fuzz::require(column.size() == table.rows(), "columns are of one length");
    for (const double value : column) fuzz::require(!std::isinf(value), "a value is a number or unset");
  }
  fuzz::require(table.columns.empty() || table.lines.size() == table.rows(), "each row has a line");
  for (const auto& issue : table.issues)
    fuzz::require(!describe("input.csv", issue).empty(), "an issue has words");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::text_of({data, size}));
  read(text, {});
  read(text, {.time_column = "", .max_issues = 3, .check_order = false, .list_repeats = false});
  return 0;
}
