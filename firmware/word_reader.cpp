#include "firmware/word_reader.hpp"

#include <algorithm>
#include <array>

namespace sandhopper {
namespace {

bool is_space_or_control(char c) noexcept {
  const auto code = static_cast<unsigned char>(c);
  return code <= 0x20 || code == 0x7F;
}

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_space_or_control(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space_or_control(text.back())) text.remove_suffix(1);
  return text;
}

// ASCII only, independent of the locale.
char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

Word word_named(std::string_view text) noexcept {
  constexpr std::array kSpoken{Word::quit, Word::stop, Word::disarm, Word::arm, Word::release};
  for (const Word word : kSpoken)
    if (std::ranges::equal(text, name_of(word), {}, lower)) return word;
  return Word::unknown;
}

void WordReader::read(std::string_view bytes, std::vector<Line>& lines) {
  while (!bytes.empty()) {
    const auto end = bytes.find('\n');
    const auto piece = bytes.substr(0, end);
    if (!skipping_) {
      pending_.append(piece.substr(0, kLongestLine + 1 - pending_.size()));
      if (pending_.size() > kLongestLine) {
        lines.push_back({Word::unknown, std::string(trimmed(pending_).substr(0, kShown))});
        pending_.clear();
        skipping_ = true;
      }
    }
    if (end == std::string_view::npos) return;
    if (!skipping_) take(pending_, lines);
    pending_.clear();
    skipping_ = false;
    bytes.remove_prefix(end + 1);
  }
}

void WordReader::end(std::vector<Line>& lines) {
  if (!skipping_) take(pending_, lines);
  pending_.clear();
  skipping_ = false;
}

void WordReader::take(std::string_view line, std::vector<Line>& lines) {
  const auto text = trimmed(line);
  if (!text.empty()) lines.push_back({word_named(text), std::string(text.substr(0, kShown))});
}

}  // namespace sandhopper
