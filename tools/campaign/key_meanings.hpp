#pragma once
#include <span>
#include <string_view>

// Texts of key_reference.hpp, one entry per key. A test finds keys without an entry and entries without a
// key.
namespace sandhopper {

struct KeyMeaning {
  std::string_view path;  // "table.key", or "key" at the top of the file
  std::string_view meaning;
  // First letters (h i f r) of the plants whose recordings have this key; a capital if no tool uses it yet.
  // Empty: every plant that has the key uses it.
  std::string_view plants = "";
};

std::span<const KeyMeaning> model_key_meanings();   // all keys except [sensors] and [spread]
std::span<const KeyMeaning> sensor_key_meanings();  // [sensors] and [spread]

}  // namespace sandhopper
