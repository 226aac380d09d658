#pragma once
#include <algorithm>
#include <cmath>
#include <string>

#include "tools/conceal/core/table.hpp"

namespace sandhopper::conceal {

// Root of the mean square of the values added; 0 if there are none.
class MeanSquare {
 public:
  void add(double value) { squares_ += value * value, count_ += 1.0; }
  void add(const MeanSquare& other) { squares_ += other.squares_, count_ += other.count_; }
  double rms() const { return count_ > 0.0 ? std::sqrt(squares_ / count_) : 0.0; }

 private:
  double squares_ = 0.0, count_ = 0.0;
};

// Calls visit(channel, row, a - b) for each row in which both tables have a sample of the channel. Rows
// are compared by their number.
template <class Visit>
void for_each_difference(const Table& a, const Table& b, const Visit& visit) {
  for (const auto& column : a.columns) {
    const auto* other = b.find(column.name);
    if (!other || column.name == "t_s") continue;
    const auto rows = std::min(column.values.size(), other->values.size());
    for (std::size_t i = 0; i < rows; ++i) {
      const double d = column.values[i] - other->values[i];
      if (!std::isnan(d)) visit(column.name, i, d);
    }
  }
}

}  // namespace sandhopper::conceal
