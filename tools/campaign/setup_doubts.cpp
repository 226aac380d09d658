#include "tools/campaign/setup_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "config/hint.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/setup_keys.hpp"
#include "tools/campaign/setup_sizes.hpp"
#include "tools/campaign/written_unit.hpp"

namespace sandhopper {
namespace {

// Most misspelt words (80 % in Damerau, "A technique for computer detection and correction of spelling
// errors", Comm. ACM 7 (1964) 171) differ by one letter: one too many, too few, another, or two exchanged.
// A digit is no misspelling: "radius_1" numbers a key.
bool is_misspelling(std::string_view a, std::string_view b) {
  constexpr std::size_t kShortest = 5;  // One letter of a shorter word makes another word: mass, wait, gait.
  if (std::min(a.size(), b.size()) < kShortest) return false;
  if (a.size() > b.size()) std::swap(a, b);
  if (b.size() - a.size() > 1) return false;
  const auto [x, y] = std::ranges::mismatch(a, b);
  const auto at = static_cast<std::size_t>(x - a.begin());
  if (at == a.size() && b.size() == a.size()) return false;  // equal
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (is_digit(*y) || (x != a.end() && is_digit(*x))) return false;
  if (b.size() > a.size()) return a.substr(at) == b.substr(at + 1);
  if (a.substr(at + 1) == b.substr(at + 1)) return true;
  return at + 1 < a.size() && a[at] == b[at + 1] && a[at + 1] == b[at] &&
         a.substr(at + 2) == b.substr(at + 2);
}

class OfOneTrial {
 public:
  OfOneTrial(const CampaignTrial& trial, const std::vector<SetupWord>& words, const std::string& file)
      : trial_(trial), words_(words), file_(file), numbers_(numbers_of(trial.belief)) {}

  void judge(const SetupEntry& entry) {
    const auto known = std::ranges::find(words_, entry.key, &SetupWord::key);
    if (known != words_.end()) return judge_type(entry, *known);
    if (meaning_of_setup(entry.key)) return;
    if (const auto* word = meant_by(entry)) judge_unread(entry, *word);
  }

  std::vector<Finding> found;

 private:
  // nominal.toml's own keys are checked where they are read (override_belief).
  void judge_type(const SetupEntry& entry, const SetupWord& word) {
    const auto* text = std::get_if<std::string>(&entry.value);
    const bool is_asked = text != nullptr && *text == kUnknownNumber;  // refused where it is read
    if (text == nullptr || is_asked || !word.takes_number || !word.path.empty()) return;
    const auto number = number_in_text(*text);
    const auto value = number ? in_unit_of(word, *number) : std::nullopt;
    add(entry, fmt::format("is the text \"{}\", and a number is needed", *text),
        value ? line_of(word, *value) : fmt::format("write a number: {} = …", word.key));
  }

  // The known key whose quantity the entry names, in another unit or with a wrong letter.
  const SetupWord* meant_by(const SetupEntry& entry) const {
    const auto parts = parts_of_key(entry.key);
    const auto name = plain_name(parts.quantity);
    const auto fits = [&](const SetupWord& word) {
      return parts.dimension.empty() || parts.dimension == word.dimension;
    };
    for (const auto& word : words_)
      if (fits(word) && std::ranges::find(word.names, name) != word.names.end()) return &word;
    for (const auto& word : words_)
      if (parts.dimension == word.dimension && is_misspelling(name, word.names.front())) return &word;
    return nullptr;
  }

  void judge_unread(const SetupEntry& entry, const SetupWord& word) {
    const bool is_stated = std::ranges::find(trial_.setup, word.key, &SetupEntry::key) != trial_.setup.end();
    if (is_stated) return;
    const auto parts = parts_of_key(entry.key);
    const auto value = value_of(entry, parts, word);
    if (std::holds_alternative<std::string>(entry.value) && !value) return;  // a word of the laboratory's own
    if (std::holds_alternative<bool>(entry.value) == word.takes_number) return;
    if (value && says_what_is_believed(word, *value)) return;
    add(entry, why(parts, word), value ? line_of(word, *value) : fmt::format("write {} = …", word.key));
  }

  static std::string why(const KeyParts& parts, const SetupWord& word) {
    const auto unit = unit_of_key(word.key);
    const bool same = std::ranges::find(word.names, plain_name(parts.quantity)) != word.names.end();
    if (same && parts.dimension.empty() && !word.dimension.empty())
      return fmt::format("states no unit and is not read: the key is {}, in {}", word.key, unit);
    if (same && std::abs(parts.to_si / word.to_si - 1.0) > kSameScale)
      return fmt::format("is in {} and is not read: the unit is {}", parts.unit, unit);
    return fmt::format("is not a key of this plant and is not read: the key is {}", word.key);
  }

  // The entry's number in the unit of `word`; empty for a word, or a number without a unit.
  static std::optional<double> value_of(const SetupEntry& entry, const KeyParts& parts,
                                        const SetupWord& word) {
    if (const auto* number = std::get_if<double>(&entry.value)) {
      if (parts.dimension != word.dimension) return std::nullopt;
      return *number * parts.to_si / word.to_si;
    }
    const auto* text = std::get_if<std::string>(&entry.value);
    const auto number = text == nullptr ? std::nullopt : number_in_text(*text);
    return number ? in_unit_of(word, *number) : std::nullopt;
  }

  static std::optional<double> in_unit_of(const SetupWord& word, const WrittenNumber& number) {
    if (number.dimension.empty()) return number.value;
    if (number.dimension != word.dimension) return std::nullopt;
    return number.value * number.to_si / word.to_si;
  }

  bool says_what_is_believed(const SetupWord& word, double value) const {
    const auto believed = numbers_.find(word.path);
    if (believed != numbers_.end()) return std::abs(value - believed->second) <= kSameScale * std::abs(value);
    const auto size = believed_diameter_m(trial_.belief);
    const bool is_size = std::ranges::find(kDiameterKeys, word.key) != kDiameterKeys.end();
    return is_size && size && std::abs(value - *size) <= kSameScale * *size;
  }

  static std::string line_of(const SetupWord& word, double value) {
    return fmt::format("write {} = {:.6g}", word.key, value);
  }

  void add(const SetupEntry& entry, std::string what, std::string cure) {
    const auto at = entry.node.key_position;
    found.push_back({FindingKind::set_up, FindingSeverity::trial_unusable, file_, at.line, at.column,
                     entry.key, std::move(what), std::move(cure)});
  }

  const CampaignTrial& trial_;
  const std::vector<SetupWord>& words_;
  const std::string& file_;
  std::map<std::string, double> numbers_;
};

}  // namespace

SetupDoubts::SetupDoubts(CampaignPlant plant, std::string file)
    : plant_(plant), file_(std::move(file)), words_(setup_words(plant)) {}

std::vector<Finding> SetupDoubts::of(const CampaignTrial& trial) const {
  if (trial.setup.empty()) return {};
  std::vector<Finding> found;
  if (auto contradiction = contradicting_sizes(trial, plant_, file_))
    found.push_back(std::move(*contradiction));
  OfOneTrial judged(trial, words_, file_);
  for (const auto& entry : trial.setup)
    if (found.empty() || found.front().channel != entry.key) judged.judge(entry);
  std::ranges::move(judged.found, std::back_inserter(found));
  return found;
}

}  // namespace sandhopper
