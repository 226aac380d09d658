#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace sandhopper {

// A cell that holds a number in a form that is not read, such as "[1.2]" or "1.2 N".
struct CellForm {
  std::string name;  // "an array as Python prints it"
  std::string cure;  // how to write the numbers alone
};

// Empty for a cell without a number, and for a number in a form that is not known.
std::optional<CellForm> form_of_cell(std::string_view cell);

}  // namespace sandhopper
