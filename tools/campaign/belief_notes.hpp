#pragma once
#include <string>
#include <string_view>

namespace sandhopper {

// The unit at the end of a key, as one writes it: "N m s" of viscous_friction_Nm_s.
std::string belief_unit(std::string_view key);

// Why the default of a key of nominal.toml is what it is; `path` is "table.key".
std::string_view reason_of_default(std::string_view path);

// The plant cannot do without the number, and its default is only a stand-in.
bool is_needed(std::string_view path);

}  // namespace sandhopper
