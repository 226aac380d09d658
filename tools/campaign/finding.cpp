#include "tools/campaign/finding.hpp"

#include <fmt/format.h>

#include <algorithm>

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

bool any_unusable(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.severity == FindingSeverity::trial_unusable;
  });
}

}  // namespace sandhopper
