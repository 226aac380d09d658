#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The text in which a unit is written: its brackets, and the words beside it.
namespace sandhopper {

// The text with plain brackets and letters for those of full width, and round brackets for {kN}, <kN> and
// those of Chinese and Japanese texts.
std::string in_plain_signs(std::string_view text);

// Text in the last brackets, [] before (), without the blanks around it.
std::optional<std::string_view> text_in_brackets(std::string_view name);

// The text without its last brackets and what is in them.
std::string without_brackets(std::string_view name);

// "10^-3" for a power of ten that is written with raised digits.
std::string with_plain_powers(std::string_view text);

// Words between blanks, commas and semicolons.
std::vector<std::string_view> words_beside_unit(std::string_view text);

// True for a text with a factor: "x1000", "N*1e-3", "1/100", "10^3", "hundredths of mm". Not for "500 N", the
// range of a load cell, nor for "m/s2".
bool holds_factor(std::string_view text);

// True for a word that is a unit spelled out, known or not: "kilopond", "decanewton".
bool begins_with_prefix(std::string_view word);

// Number of characters of a UTF-8 text.
std::size_t characters_in(std::string_view text);

}  // namespace sandhopper
