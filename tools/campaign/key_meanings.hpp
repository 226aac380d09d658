#pragma once
#include <span>
#include <string_view>

// The sentences of key_reference.hpp. One entry a key; a test names keys without one and entries without a
// key.
namespace sandhopper {

struct KeyMeaning {
  std::string_view path;  // "table.key", or "key" at the top of the file
  std::string_view meaning;
  // First letters of the plants to whose recordings the key belongs (h i f r), a capital where no tool uses
  // it so far; empty: every plant that has the key uses it.
  std::string_view plants = "";
};

std::span<const KeyMeaning> model_key_meanings();   // everything but [sensors] and [spread]
std::span<const KeyMeaning> sensor_key_meanings();  // [sensors] and [spread]

}  // namespace sandhopper
