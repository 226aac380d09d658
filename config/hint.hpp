#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Suggestions for messages about an unknown word.
namespace sandhopper {

// Known words nearest to `word` by edit distance, best first, at most `limit`. Empty if none is near.
std::vector<std::string> nearest_words(std::string_view word, std::span<const std::string> known,
                                       std::size_t limit = 3);

// Joins words with "or": "'a'", "'a' or 'b'", "'a', 'b' or 'c'".
std::string either(std::span<const std::string> words);

// Splits a key with a unit: "force_kN" is quantity "force", suffix "kN", 1000 times the SI unit (0: not a
// plain multiple). Empty for a key without a known unit.
struct UnitOfKey {
  std::string_view quantity;
  std::string_view suffix;
  std::string_view dimension;
  double to_si = 1.0;
};
std::optional<UnitOfKey> split_unit(std::string_view key);

// Last key of a path, without an element's index: "mass_kg" of "body.mass_kg". It carries the unit.
std::string_view last_key(std::string_view path);

// Unit at the end of a key in usual notation ("kg", "N/m"); empty for a key without one.
std::string unit_of_key(std::string_view key);

// Cure for an unknown key: the same quantity in the expected unit with the converted value, a known key that
// contains this one, or the nearest spelling. `candidates` are tried in the given order.
std::string cure_for_unknown_key(std::string_view key, std::optional<double> value,
                                 std::span<const std::string> candidates);

}  // namespace sandhopper
