#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// What a message suggests when a word is not among those known.
namespace sandhopper {

// Known words nearest to `word` by edit distance, best first, at most `limit`; empty when none is near.
std::vector<std::string> nearest_words(std::string_view word, std::span<const std::string> known,
                                       std::size_t limit = 3);

// "'a'", "'a' or 'b'", "'a', 'b' or 'c'"
std::string either(std::span<const std::string> words);

// "force_kN" is quantity "force" in "kN", a "force" that is 1000 times its SI unit (0: not a plain multiple).
// Empty for a key that ends in no known unit.
struct UnitOfKey {
  std::string_view quantity;
  std::string_view suffix;
  std::string_view dimension;
  double to_si = 1.0;
};
std::optional<UnitOfKey> split_unit(std::string_view key);

// Unit at the end of a key as one writes it ("kg", "N/m"), empty for a key without one.
std::string unit_of_key(std::string_view key);

// Cure for an unknown key: the same quantity in the expected unit with the value converted, a key of which
// this is a part, or the nearest spelling. Keys in `candidates` are tried in the order given.
std::string cure_for_unknown_key(std::string_view key, std::optional<double> value,
                                 std::span<const std::string> candidates);

}  // namespace sandhopper
