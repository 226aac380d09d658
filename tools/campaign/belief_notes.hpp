#pragma once
#include <string_view>

namespace sandhopper {

// Reason for the default of a key of nominal.toml. `path`: "table.key".
std::string_view reason_of_default(std::string_view path);

// True if the plant needs the number and its default is only a placeholder.
bool is_needed(std::string_view path);

}  // namespace sandhopper
