#include "firmware/log/mcap_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sandhopper::mcap {
namespace {

constexpr std::uint64_t kFooterBytes = 20;  // content of the footer record

bool is_magic(Bytes file, std::uint64_t offset) {
  return offset + kMagic.size() <= file.size() &&
         std::equal(kMagic.begin(), kMagic.end(), file.begin() + static_cast<std::ptrdiff_t>(offset));
}

// Next magic at or behind `from`; the file's size if there is none.
std::uint64_t next_magic(Bytes file, std::uint64_t from) {
  const auto found = std::search(file.begin() + static_cast<std::ptrdiff_t>(std::min(from, file.size())),
                                 file.end(), kMagic.begin(), kMagic.end());
  return static_cast<std::uint64_t>(found - file.begin());
}

// True if a header record follows the magic: two texts that fill it.
bool begins_log(Bytes file, std::uint64_t magic) {
  const Bytes rest = file.subspan(static_cast<std::size_t>(magic + kMagic.size()));
  Cursor in(rest);
  if (in.take<Op>() != Op::header) return false;
  Cursor content(in.take(in.take<std::uint64_t>()));
  content.take_text();
  content.take_text();
  return in.ok && content.ok && content.rest().empty();
}

bool ends_log(Bytes file, std::uint64_t magic) {
  if (magic < kRecordHead + kFooterBytes) return false;
  const std::uint64_t footer = magic - kRecordHead - kFooterBytes;
  return static_cast<Op>(file[static_cast<std::size_t>(footer)]) == Op::footer &&
         length_at(file, footer) == kFooterBytes;
}

Bytes bytes_in(Bytes file, const Part& part) {
  return file.subspan(static_cast<std::size_t>(part.from), static_cast<std::size_t>(part.to - part.from));
}

// The part without what follows the last footer and magic.
OneLog without_tail(Bytes file, const Part& part) {
  OneLog out;
  out.part = part;
  out.file_bytes = file.size();
  std::uint64_t end = part.to;
  for (auto magic = next_magic(file, part.from + kMagic.size()); magic + kMagic.size() <= part.to;
       magic = next_magic(file, magic + 1))
    if (ends_log(file, magic)) end = magic + kMagic.size();
  const Bytes tail = bytes_in(file, {end, part.to});
  out.part.to = end;
  out.bytes = bytes_in(file, out.part);
  out.behind = tail.size();
  out.zeros = std::ranges::all_of(tail, [](std::byte b) { return b == std::byte{0}; });
  return out;
}

bool begins_with(Bytes text, Bytes beginning) {
  return beginning.size() <= text.size() && std::equal(beginning.begin(), beginning.end(), text.begin());
}

}  // namespace

std::vector<Part> parts_of(Bytes file) {
  std::vector<Part> out{{0, file.size()}};
  for (auto magic = next_magic(file, 1); magic < file.size(); magic = next_magic(file, magic + 1)) {
    if (!is_magic(file, magic) || !begins_log(file, magic)) continue;
    out.back().to = magic;
    out.push_back({magic, file.size()});
  }
  return out;
}

SeveralLogs::SeveralLogs(const std::filesystem::path& file, const std::vector<Part>& parts)
    : Error(fmt::format("{} holds {} different logs, one behind the other", file.string(), parts.size())) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    cure +=
        fmt::format("{}tail -c +{} '{}' | head -c {} > log_{}.mcap", i == 0 ? "cut it into its logs: " : "; ",
                    parts[i].from + 1, file.string(), parts[i].to - parts[i].from, i + 1);
}

OneLog one_log_of(Bytes file, const std::filesystem::path& name) {
  const auto parts = parts_of(file);
  std::vector<OneLog> logs;
  for (const auto& part : parts) logs.push_back(without_tail(file, part));
  const auto longest =
      *std::ranges::max_element(logs, {}, [](const OneLog& log) { return log.part.to - log.part.from; });
  for (const auto& log : logs)
    if (!begins_with(longest.bytes, log.bytes)) throw SeveralLogs(name, parts);
  OneLog out = longest;
  out.copies = logs.size();
  return out;
}

}  // namespace sandhopper::mcap
