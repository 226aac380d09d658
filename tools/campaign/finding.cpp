#include "tools/campaign/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace sandhopper {

std::string to_string(const Finding& f) {
  std::string text = f.file;
  if (f.line > 0) text += fmt::format(":{}:{}", f.line, std::max<std::uint64_t>(f.column, 1));
  if (!f.channel.empty()) text += ": " + f.channel;
  text += ": " + f.what;
  if (!f.cure.empty()) text += "; " + f.cure;
  for (char& c : text)  // Control characters could control the terminal.
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  return text;
}

namespace {

// The words of a finding, without numbers.
std::string words_of(const Finding& f) {
  std::string words =
      fmt::format("{} {} {} {} ", name_of(f.kind), name_of(f.severity), f.channel, f.what) + f.cure;
  std::erase_if(words, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+'; });
  return words;
}

struct Shared {
  const Finding* first;
  std::size_t more_files = 0;
};

}  // namespace

std::vector<std::string> in_lines(const std::vector<Finding>& findings, bool with_severity) {
  std::vector<Shared> shared;
  // By the words and how often they came before in the same file: two gaps in one file are two lines.
  std::map<std::pair<std::string, std::size_t>, std::size_t> places;
  std::map<std::pair<std::string, std::string>, std::size_t> in_file;
  std::set<std::string> seen;
  for (const auto& finding : findings) {
    if (!seen.insert(to_string(finding)).second) continue;
    const auto words = words_of(finding);
    const auto nth = in_file[{words, finding.file}]++;
    const auto [place, is_new] = places.emplace(std::pair(words, nth), shared.size());
    if (is_new)
      shared.push_back({&finding});
    else
      ++shared[place->second].more_files;
  }
  std::vector<std::string> lines;
  for (const auto& [first, more_files] : shared) {
    std::string end = with_severity ? std::string(name_of(first->severity)) : "";
    if (more_files > 0)
      end += fmt::format("{}likewise in {} more file{}", end.empty() ? "" : "; ", more_files,
                         more_files > 1 ? "s" : "");
    lines.push_back(to_string(*first) + (end.empty() ? "" : " (" + end + ")"));
  }
  return lines;
}

bool any_unusable(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.severity == FindingSeverity::trial_unusable;
  });
}

}  // namespace sandhopper
