#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "tools/campaign/text_rows.hpp"

namespace sandhopper {

// Times that step back although they grow if their text is read in another way.
struct TimeTextDoubt {
  enum class Kind : std::uint8_t {
    counted_fraction,  // 100.9, 100.10: the digits behind the point are a count that is not padded with zeros
    sorted_as_text     // 1, 10, 2: the rows are in the order of the alphabet
  };
  Kind kind{};
  std::uint64_t line = 0;  // the first that steps back
  std::string before{}, after{};
};

// Compares the texts of a time column from row to row. A doubt needs every row: one that contradicts it ends
// it.
class TimeTexts {
 public:
  TimeTexts(const CsvTable& table, std::size_t column) : table_(table), column_(column) {}

  void take(const TextRow& row);
  std::optional<TimeTextDoubt> doubt() const;

 private:
  struct Parts {
    std::uint64_t whole = 0, fraction = 0;
    auto operator<=>(const Parts&) const = default;
  };
  static std::optional<Parts> parts_of(std::string_view text, char decimal);

  const CsvTable& table_;
  std::size_t column_;
  std::string last_;
  bool may_be_counted_ = true, may_be_sorted_ = true;
  TimeTextDoubt first_back_{};
};

}  // namespace sandhopper
