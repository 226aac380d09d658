#include "tools/campaign/unit_text.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace sandhopper {
namespace {

constexpr bool is_a_digit(char c) { return c >= '0' && c <= '9'; }

std::string small_letters(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}

std::string_view without_edges(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  return begin == std::string_view::npos ? "" : text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

// A character of full width (U+FF01 to U+FF5E: 0x21 to 0x7E, three bytes each); '\0' for another.
char of_full_width(std::string_view text) {
  if (text.size() < 3 || text[0] != '\xEF') return '\0';
  const unsigned second = static_cast<unsigned char>(text[1]), third = static_cast<unsigned char>(text[2]);
  const unsigned code = 0xF000U | ((second & 0x3FU) << 6U) | (third & 0x3FU);
  return code >= 0xFF01 && code <= 0xFF5E ? static_cast<char>(code - 0xFF01 + 0x21) : '\0';
}

// Words that make a unit larger or smaller; others beside a unit are remarks ("kN, filtered").
bool is_word_of_scale(std::string_view word) {
  constexpr std::array<std::string_view, 28> kWords{
      "tenth",    "tenths",      "hundredth",   "hundredths", "thousandth", "thousandths", "millionth",
      "ten",      "tens",        "hundred",     "hundreds",   "thousand",   "thousands",   "million",
      "millions", "millionths",  "half",        "double",     "times",      "per",         "kilo",
      "milli",    "hundertstel", "tausendstel", "zehntel",    "micro",      "pi",          "\xCF\x80"};
  return std::ranges::find(kWords, small_letters(word)) != kWords.end();
}

}  // namespace

std::string in_plain_signs(std::string_view text) {
  struct Sign {
    std::string_view written, plain;
  };
  constexpr std::array<Sign, 9> kSigns{{{"\xE3\x80\x90", "("},
                                        {"\xE3\x80\x91", ")"},
                                        {"\xE3\x80\x94", "("},
                                        {"\xE3\x80\x95", ")"},
                                        {"\xE3\x80\x88", "("},
                                        {"\xE3\x80\x89", ")"},
                                        {"\xE3\x80\x80", " "},
                                        {"{", "("},
                                        {"}", ")"}}};
  std::string out;
  while (!text.empty()) {
    const auto sign =
        std::ranges::find_if(kSigns, [&](const Sign& s) { return text.starts_with(s.written); });
    const char wide = of_full_width(text);
    if (sign != kSigns.end())
      out += sign->plain;
    else
      out += wide != '\0' ? wide : text.front();
    text.remove_prefix(sign != kSigns.end() ? sign->written.size() : wide != '\0' ? 3 : 1);
  }
  const auto open = out.find('<');
  if (const auto close = out.rfind('>');
      open != std::string::npos && close != std::string::npos && open < close)
    out[open] = '(', out[close] = ')';
  return out;
}

std::optional<std::string_view> text_in_brackets(std::string_view name) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const auto end = name.rfind(close);
    const auto begin = name.rfind(open, end);
    if (end == std::string_view::npos || begin == std::string_view::npos || end < begin + 2) continue;
    return without_edges(name.substr(begin + 1, end - begin - 1));
  }
  return std::nullopt;
}

std::string without_brackets(std::string_view name) {
  const auto inner = text_in_brackets(name);
  if (!inner) return std::string(name);
  const auto begin = static_cast<std::size_t>(inner->data() - name.data());
  const auto open = name.find_last_of("[(", begin - 1),
             close = name.find_first_of(")]", begin + inner->size());
  return std::string(name.substr(0, open)) + " " + std::string(name.substr(close + 1));
}

std::string with_plain_powers(std::string_view text) {
  struct Raised {
    std::string_view sign, plain;
  };
  constexpr std::array<Raised, 11> kSigns{{{"\xE2\x81\xBB", "-"},
                                           {"\xE2\x81\xB0", "0"},
                                           {"\xC2\xB9", "1"},
                                           {"\xC2\xB2", "2"},
                                           {"\xC2\xB3", "3"},
                                           {"\xE2\x81\xB4", "4"},
                                           {"\xE2\x81\xB5", "5"},
                                           {"\xE2\x81\xB6", "6"},
                                           {"\xE2\x81\xB7", "7"},
                                           {"\xE2\x81\xB8", "8"},
                                           {"\xE2\x81\xB9", "9"}}};
  const auto at = text.find("10");
  if (at == std::string_view::npos) return std::string(text);
  std::string power;
  auto rest = text.substr(at + 2);
  for (bool found = true; found;) {
    const auto raised =
        std::ranges::find_if(kSigns, [&](const Raised& r) { return rest.starts_with(r.sign); });
    found = raised != kSigns.end();
    if (found) power += raised->plain, rest.remove_prefix(raised->sign.size());
  }
  return std::string(text.substr(0, at + 2)) + (power.empty() ? "" : "^" + power) + std::string(rest);
}

std::vector<std::string_view> words_beside_unit(std::string_view text) {
  constexpr std::string_view kBetween = " \t,;";
  std::vector<std::string_view> words;
  while (true) {
    const auto begin = text.find_first_not_of(kBetween);
    if (begin == std::string_view::npos) return words;
    text.remove_prefix(begin);
    const auto end = std::min(text.find_first_of(kBetween), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

bool holds_factor(std::string_view text) {
  const auto words = words_beside_unit(text);
  if (std::ranges::any_of(words, is_word_of_scale)) return true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!is_a_digit(text[i])) continue;
    const auto before = without_edges(text.substr(0, i));
    const bool is_multiplied =
        std::ranges::any_of(std::array<std::string_view, 4>{"*", "/", "\xC3\x97", "10^"},
                            [&](std::string_view mark) { return before.ends_with(mark); });
    // "x1000", "(x 10)", but not "max 5" and not the sensor "x1".
    const bool has_x = before == "x" || before == "X" || before.ends_with(" x") || before.ends_with(",x");
    const bool has_exponent = i + 2 < text.size() && (text[i + 1] == 'e' || text[i + 1] == 'E') &&
                              (is_a_digit(text[i + 2]) || text[i + 2] == '-');
    if (is_multiplied || has_exponent) return true;
    if (has_x && i + 1 < text.size() && is_a_digit(text[i + 1])) return true;
    while (i + 1 < text.size() && is_a_digit(text[i + 1])) ++i;
  }
  return false;
}

bool begins_with_prefix(std::string_view word) {
  constexpr std::array<std::string_view, 11> kPrefixes{"kilo",  "milli", "micro", "nano", "mega", "giga",
                                                       "centi", "deci",  "deca",  "deka", "hecto"};
  const auto lower = small_letters(word);
  return std::ranges::any_of(kPrefixes, [&](std::string_view prefix) { return lower.starts_with(prefix); });
}

std::size_t characters_in(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace sandhopper
