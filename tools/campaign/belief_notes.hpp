#pragma once
#include <string>
#include <string_view>

namespace sandhopper {

// What a key of nominal.toml does, in a few words, and why its default is what it is. Keys of [sensors] and
// [spread] are explained by how they end. Empty for a key that is not listed.
struct BeliefNote {
  std::string does;
  std::string default_reason;
};
// The unit at the end of a key, as one writes it: "N m s" of viscous_friction_Nm_s.
std::string belief_unit(std::string_view key);
BeliefNote belief_note(std::string_view table, std::string_view key);

}  // namespace sandhopper
