#include "tools/trial/trace/foreign_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <regex>
#include <string_view>
#include <system_error>

namespace sandhopper::trace {
namespace {

constexpr std::size_t kSeen = 4096;  // number of bytes that are examined

using namespace std::string_view_literals;

struct Magic {
  std::string_view bytes;
  const char* what;
  const char* cure;  // {0} is the file, {1} the file with the ending .log
};

// python-can reads ASC, BLF, TRC, CSV and its own database, and writes candump text if the file ends in .log.
constexpr const char* kPythonCan = "python3 -m can.logconvert '{0}' '{1}' (Debian: python3-can)";
// MF4 needs python-can 4.2 and asammdf; Debian 12 has version 4.1.
constexpr const char* kPythonCanOfToday =
    "pip install 'python-can[mf4]', then python3 -m can.logconvert '{0}' '{1}'";
// Identifiers of more than 11 bits need eight digits; tshark 4 prints them as decimal numbers. A remote frame
// has no data: its length stands behind R.
constexpr const char* kCapture =
    "tshark -r '{0}' -T fields -e frame.time_epoch -e can.flags.xtd -e can.id -e can.flags.rtr -e can.len -e "
    "data.data | awk '{{ d = $4 ~ /^(1|True)$/ ? \"R\" $5 : toupper($6); printf($2 ~ /^(1|True)$/ ? \"(%.6f) "
    "can0 %08X#%s\\n\" : \"(%.6f) can0 %03X#%s\\n\", $1, $3, d) }}' > '{1}' (Debian: tshark)";

constexpr std::array kMagics{
    Magic{"LOGG"sv, "a Vector BLF log", kPythonCan},
    Magic{"MDF     "sv, "an ASAM MDF file", kPythonCanOfToday},
    Magic{"SQLite format 3"sv, "a database of python-can", kPythonCan},
    Magic{"#ROSBAG V"sv, "a bag of ROS 1",
          "play it into a virtual bus with topic_to_socketcan_node of socketcan_bridge, and record that: "
          "candump "
          "-L vcan0 > '{1}'"},
    Magic{";$FILEVERSION="sv, "a PEAK trace", kPythonCan},
    Magic{"\x89MCAP"sv, "an MCAP log", "replay it without --can: hop replay '{0}'"},
    Magic{"\x0a\x0d\x0d\x0a"sv, "a packet capture (pcapng)", kCapture},
    Magic{"\xd4\xc3\xb2\xa1"sv, "a packet capture (pcap)", kCapture},
    Magic{"\x4d\x3c\xb2\xa1"sv, "a packet capture (pcap)", kCapture},
    Magic{"\x1f\x8b"sv, "compressed with gzip", "gunzip -c '{0}' > '{1}'"},
    Magic{"\x28\xb5\x2f\xfd"sv, "compressed with zstd", "zstd -dc '{0}' > '{1}'"},
    Magic{"\xfd"
          "7zXZ"sv,
          "compressed with xz", "xz -dc '{0}' > '{1}'"},
    Magic{"version https://git-lfs.github.com/spec/"sv,
          "a pointer of git LFS to a trace that was not fetched",
          "git lfs install, then git lfs pull in that repository"},
    Magic{"/annex/objects/"sv, "a pointer of git-annex to a trace that was not fetched",
          "git annex get '{0}' in that repository"},
    Magic{"\xff\xfe"sv, "UTF-16 text, as PowerShell's > writes it", "iconv -f UTF-16 -t UTF-8 '{0}' > '{1}'"},
    Magic{"\xfe\xff"sv, "UTF-16 text", "iconv -f UTF-16 -t UTF-8 '{0}' > '{1}'"}};

// Joins the cells after "[8]". Interface and identifier come before it with every option of candump. A remote
// frame has the words "remote request" in place of data; the length of a CAN FD frame has two digits. Lines
// about lost frames are kept as comments. candump -S writes the bytes in the other order, with ` between
// them.
constexpr const char* kLongCandump =
    "awk '/DROPCOUNT/ {{ print \"# \" $0 }} /^ *\\([0-9.]+\\)/ {{ for (i = 3; i <= NF && $i !~ /^\\[/; ++i); "
    "n = substr($i, 2, length($i) - 2); d = length(n) > 1 ? \"##0\" : \"#\"; if (/remote request/) d = "
    "\"#R\" "
    "n; else if ($(i + 1) ~ /`/) for (j = split($(i + 1), b, \"`\"); j > 0; --j) d = d b[j]; else for (j = i "
    "+ "
    "1; j <= NF && $j ~ /^[0-9A-F][0-9A-F]$/; ++j) d = d $j; print $1, $2, $(i - 1) d }}' '{0}' > '{1}'";
// Between identifier and length stand letters: S standard, E error, R remote, F CAN FD.
constexpr const char* kPrinted =
    "awk '/^Timestamp:/ {{ d = \"#\"; id = toupper($4); for (i = 5; i <= NF && $i != \"DL:\"; ++i) {{ if ($i "
    "== "
    "\"R\") d = \"#R\"; if ($i == \"F\") d = \"##0\"; if ($i == \"S\") id = substr(\"000\" id, "
    "length(id) + 1); if ($i == \"E\") id = \"2\" substr(\"0000000\" id, length(id) + 1) }} n = $(i + 1); if "
    "(d "
    "== \"#R\") d = d n; else for (j = i + 2; j < i + 2 + n; ++j) d = d toupper($j); print \"(\" $2 \") can0 "
    "\" "
    "id d }}' '{0}' > '{1}'";

// tIIILDD... or TIIIIIIIILDD... with the milliseconds of a minute as four digits behind the data; each frame
// ends with a carriage return.
constexpr const char* kSlcan =
    "perl -015 -ne 'next unless /^(?:t(\\w{{3}})|T(\\w{{8}}))(\\d)(\\w*)/; ($i, $n, $d) = (uc($1 // $2), $3, "
    "$4); $t = hex(substr($d, 2 * $n, 4)); $w += 60000 if defined $l && $t < $l; $l = $t; "
    "printf(\"(%d.%03d000) can0 %s#%s\\n\", ($w + $t) / 1000, ($w + $t) % 1000, $i, uc(substr($d, 0, 2 * "
    "$n)))' '{0}' > '{1}'";

// The first time becomes 0.
constexpr const char* kNegative =
    "awk '/^[(]/ {{ t = substr($1, 2) + 0; if (!n++) b = t; sub(/^[(][-0-9.]+/, sprintf(\"(%.6f\", t - b)) "
    "}} "
    "1' '{0}' > '{1}'";
constexpr const char* kPadded =
    "import these columns as text into the spreadsheet; if every frame had eight bytes, the zeros can be put "
    "back: awk '/^[(]/ {{ split($3, p, \"#\"); while (length(p[1]) < 3) p[1] = \"0\" p[1]; while "
    "(length(p[2]) < 16) p[2] = \"0\" p[2]; $3 = p[1] \"#\" p[2] }} 1' '{0}' > '{1}'";
constexpr const char* kUncoloured = "sed 's/\\x1b\\[[0-9;]*m//g' '{0}'";

struct Pattern {
  const char* regex;  // matches a line
  const char* what;
  const char* cure;
};
constexpr std::array kPatterns{
    // asc2log reads these wrongly (can-utils issue 348).
    Pattern{R"(^\s*base\s+(hex|dec)\s+no internal events logged.*)", "an ASC log of BUSMASTER", kPythonCan},
    Pattern{R"(^\s*base\s+(hex|dec)\s+timestamps\s+(absolute|relative).*)", "a Vector ASC log",
            "asc2log -I '{0}' -O '{1}' (Debian: can-utils), or python3 -m can.logconvert '{0}' '{1}'"},
    Pattern{R"(^\s*\([0-9]+\.[0-9]+\)\s+\S+\s.*\[[0-9]+\].*)", "candump's output without -L", kLongCandump},
    Pattern{R"(^\s*\([0-9]{4}-[0-9]{2}-[0-9]{2} .*\[[0-9]+\].*)", "candump's output with dates (-tA)",
            "record again with candump -L can0 > '{1}'"},
    Pattern{R"(^\s+\S+\s+(RX|TX)?.*[0-9A-F]{3,8}\s+\[[0-9]+\].*)",
            "candump's output without -L and without times: it cannot be paired or timed",
            "record again with candump -L can0 > '{1}'"},
    Pattern{R"(^timestamp,arbitration_id,extended,.*)", "a CSV file of python-can", kPythonCan},
    Pattern{R"(^Timestamp:\s+[0-9.]+\s+ID:\s+[0-9a-fA-F]+.*DL:.*)", "python-can's printed messages",
            kPrinted},
    Pattern{R"(^Time Stamp,ID,Extended,.*)", "a CSV file of SavvyCAN",
            "open it in SavvyCAN and save it as \"Linux candump\" under '{1}'"},
    Pattern{R"(^\([0-9]+,[0-9]+\)\s+\S+\s+[0-9A-Fa-f]+#.*)",
            "text of candump with a comma for the decimal point of its times",
            "sed -E 's/^[(]([0-9]+),/(\\1./' '{0}' > '{1}'"},
    Pattern{R"(^\(-[0-9]+\.[0-9]+\)\s+\S+\s+[0-9A-Fa-f]+#.*)",
            "text of candump with negative times, as a recorder writes that counts from its trigger",
            kNegative},
    Pattern{R"(^(t[0-9A-Fa-f]{4,}|T[0-9A-Fa-f]{9,})\r[\s\S]*)",
            "a dump of an slcan adapter, with times in whole milliseconds", kSlcan}};

std::string beginning_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::system_error(errno, std::generic_category(), file.string());
  std::string text(kSeen, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    lines.emplace_back(text, begin, end - begin);
    if (!lines.back().empty() && lines.back().back() == '\r') lines.back().pop_back();
    begin = end + 1;
  }
  return lines;
}

// Identifiers of one or two digits in at least half of the frames; a damaged line may have one, too.
bool lost_leading_zeros(const std::vector<std::string>& lines) {
  static const std::regex frame(R"(^\([0-9.]+\)\s+\S+\s+[0-9A-Fa-f]+#.*)");
  static const std::regex lost(R"(^\([0-9.]+\)\s+\S+\s+[0-9A-Fa-f]{1,2}#[0-9A-Fa-f]*\s*)");
  std::size_t frames = 0, short_ones = 0;
  for (const auto& line : lines) {
    frames += std::regex_match(line, frame);
    short_ones += std::regex_match(line, lost);
  }
  return frames > 0 && 2 * short_ones >= frames;
}

std::optional<ForeignFormat> by_lines(const std::string& text, const std::string& file,
                                      const std::string& log) {
  const auto lines = lines_of(text);
  for (const auto& pattern : kPatterns) {
    const std::regex regex(pattern.regex);
    for (const auto& line : lines)
      if (std::regex_match(line, regex))
        return ForeignFormat{pattern.what, fmt::format(fmt::runtime(pattern.cure), file, log)};
  }
  if (lost_leading_zeros(lines))
    return ForeignFormat{
        "text of candump without the leading zeros of identifiers and data, as a spreadsheet saves it",
        fmt::format(fmt::runtime(kPadded), file, log)};
  return std::nullopt;
}

// Text with the colours of a terminal, as candump -c writes it. The cure also converts what is below them, if
// that is one command on the file.
std::optional<ForeignFormat> coloured(const std::string& text, const std::string& file,
                                      const std::string& log) {
  static const std::regex colour("\x1b\\[[0-9;]*m");
  if (!std::regex_search(text, colour)) return std::nullopt;
  const std::string plain = fmt::format(fmt::runtime(kUncoloured), file);
  ForeignFormat out{"text with the colours of a terminal, as candump -c writes it",
                    fmt::format("{} > '{}'", plain, log)};
  const auto below = by_lines(std::regex_replace(text, colour, ""), file, log);
  if (!below) return out;
  const std::string from = fmt::format(" '{}' > ", file);
  const auto place = below->cure.find(from);
  out.what = fmt::format("{} with the colours of a terminal (candump -c)", below->what);
  if (place != std::string::npos && below->cure.starts_with("awk "))
    out.cure = fmt::format("{} | {} > {}", plain, below->cure.substr(0, place),
                           below->cure.substr(place + from.size()));
  return out;
}

}  // namespace

std::optional<ForeignFormat> recognise_format(const std::filesystem::path& file) {
  const std::string text = beginning_of(file);
  auto converted = std::filesystem::path(file).replace_extension(".log");
  if (converted == file) converted = file.stem().string() + ".candump.log";
  const std::string log = converted.filename().string();
  for (const auto& magic : kMagics)
    if (text.starts_with(magic.bytes))
      return ForeignFormat{magic.what, fmt::format(fmt::runtime(magic.cure), file.string(), log)};
  if (auto format = coloured(text, file.string(), log)) return format;
  return by_lines(text, file.string(), log);
}

}  // namespace sandhopper::trace
