#include "firmware/log/csv_text.hpp"

#include <algorithm>
#include <array>
#include <istream>
#include <iterator>

#include "firmware/log/csv_cells.hpp"
#include "firmware/log/csv_code_pages.hpp"

namespace sandhopper {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kLookedAt = 1 << 16;  // bytes read to detect the format
constexpr std::size_t kMostBreaks = 8;      // most lines over which the names of a table may be spread

constexpr std::string_view kSaveAsCsv =
    "open it in the program that wrote it and save it as CSV UTF-8 (Excel: File, Save as, \"CSV UTF-8\"), "
    "then "
    "name that file";
constexpr std::string_view kPandas =
    "write it as a table: python3 -c \"import pandas as pd; pd.read_…('FILE').to_csv('FILE.csv', "
    "index=False)\"";

struct Magic {
  std::string_view bytes;
  BinaryFormat format;
};
constexpr std::array kMagic{
    Magic{"PK\x03\x04"sv, {"a spreadsheet or another zip archive (.xlsx, .ods, .zip)", kSaveAsCsv}},
    Magic{"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, {"an old Excel file (.xls)", kSaveAsCsv}},
    Magic{"\x89HDF\r\n\x1A\n"sv, {"an HDF5 file (.h5, .mat of version 7.3)", kPandas}},
    Magic{"MATLAB 5.0 MAT-file"sv, {"a MATLAB file (.mat)", "in MATLAB: writetable(T, 'FILE.csv')"}},
    Magic{"PAR1"sv, {"a Parquet file", kPandas}},
    Magic{
        "TDSm"sv,
        {"a LabVIEW measurement (.tdms)", "export it as text from LabVIEW or Excel, or by npTDMS in Python"}},
    Magic{"\x1F\x8B"sv, {"compressed (.gz)", "unpack it with gunzip and name the table inside"}},
    Magic{"\x28\xB5\x2F\xFD"sv, {"compressed (.zst)", "unpack it with unzstd and name the table inside"}},
    Magic{"#ROSBAG V"sv,
          {"a ROS 1 bag", "write the topic as a table: rostopic echo -b FILE -p /TOPIC > FILE.csv"}},
    Magic{
        "LOGG"sv,
        {"a Vector BLF log of CAN frames",
         "for the drives' replies: hop replay --can FILE says how to convert it; for signals: export them as "
         "CSV from the program that has their DBC file"}},
    Magic{"MDF     "sv,
          {"an ASAM MDF file (.mf4, .dat)",
           "export its signals as CSV: pip install asammdf, then asammdf's mdf.export('csv', "
           "filename='FILE.csv')"}},
    Magic{"SQLite format 3"sv,
          {"a database (SQLite, or a ROS 2 bag)", "write the topic as a table and name it"}},
    Magic{"\x93NUMPY"sv,
          {"a NumPy array (.npy)",
           "write it as a table: numpy.savetxt('FILE.csv', a, delimiter=',', header='t_s,…')"}},
    Magic{"%PDF"sv, {"a PDF", "export the table itself as CSV"}},
    Magic{"\x89MCAP0\r\n"sv, {"an MCAP log", "give it the ending .mcap"}}};

unsigned byte_at(std::string_view bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

// Names of a line such as "t:0.1,F:2.3" or "t=0.1 F=2.3", with the name before every value. Empty for another
// line.
std::vector<std::string> labels_in(std::string_view line) {
  std::vector<std::string> labels;
  const auto is_part_of_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  while (!line.empty()) {
    std::size_t n = 0;
    while (n < line.size() && is_part_of_name(line[n])) ++n;
    if (n == 0 || n == line.size() || (line[n] != ':' && line[n] != '=') ||
        (line[0] >= '0' && line[0] <= '9'))
      return {};
    labels.emplace_back(line.substr(0, n));
    line.remove_prefix(n + 1);
    const auto end = line.find_first_of(",; \t");
    if (!number_in_cell(trimmed_cell(line.substr(0, end)), {})) return {};
    line.remove_prefix(std::min(line.size(), end));
    line.remove_prefix(std::min(line.size(), line.find_first_not_of(",; \t")));
  }
  return labels.size() > 1 ? labels : std::vector<std::string>{};
}

// A small text that stands in for a recording that was not fetched.
std::optional<OtherText> stand_in_text(std::string_view line) {
  if (line.starts_with("version https://git-lfs.github.com/spec/") ||
      line.starts_with("version https://hawser.github.com/spec/"))
    return OtherText{"a pointer of git LFS to the recording, which was not fetched",
                     "run git lfs install and git lfs pull in that repository, or download the file itself"};
  if (line.starts_with("/annex/objects/") || line.starts_with("../.git/annex/objects/") ||
      line.starts_with(".git/annex/objects/"))
    return OtherText{"a pointer of git-annex to the recording, which was not fetched",
                     "run git annex get FILE in that repository (DataLad: datalad get FILE)"};
  if (line == "outs:")
    return OtherText{"a pointer of DVC to the recording",
                     "run dvc pull in that repository, and name the recording "
                     "itself, without .dvc"};
  if (line == "404: Not Found" || line == "Not Found" || line.starts_with("AccessDenied"))
    return OtherText{"the answer of a server that did not send the recording", "download the file again"};
  return std::nullopt;
}

std::string from_utf16(std::string_view bytes, bool big_endian) {
  std::string out;
  out.reserve(bytes.size() / 2);
  const auto unit = [&](std::size_t i) -> char32_t {
    const unsigned a = byte_at(bytes, i), b = byte_at(bytes, i + 1);
    return big_endian ? (a << 8) | b : (b << 8) | a;
  };
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    char32_t c = unit(i);
    const bool pair = c >= 0xD800 && c < 0xDC00 && i + 3 < bytes.size();
    if (pair) c = 0x10000 + ((c - 0xD800) << 10) + ((unit(i += 2) - 0xDC00) & 0x3FF);
    if (c != 0xFEFF) put_utf8(out, c);
  }
  return out;
}

}  // namespace

std::optional<BinaryFormat> binary_format_of(std::string_view first_bytes) {
  for (const auto& magic : kMagic)
    if (first_bytes.starts_with(magic.bytes)) return magic.format;
  return std::nullopt;
}

std::optional<OtherText> other_text_of(std::string_view line) {
  line = trimmed_cell(line);
  if (line.starts_with('<'))
    return OtherText{"a page of HTML or XML (some programs call it .xls)", std::string(kSaveAsCsv)};
  if (line.starts_with("{\"") || line.starts_with("[{") || line == "{" || line == "[")
    return OtherText{
        "JSON",
        "write it as a table: python3 -c \"import pandas as pd; pd.read_json('FILE', "
        "lines=True).to_csv('FILE.csv', index=False)\" (without lines=True where it is one list)"};
  if (auto stand_in = stand_in_text(line)) return stand_in;
  const auto labels = labels_in(line);
  if (labels.empty()) return std::nullopt;
  std::string names;
  for (const auto& label : labels) names += (names.empty() ? "\"" : ", \"") + label + '"';
  return OtherText{"a text with a name before every value",
                   "take the names away: sed -E 's/[A-Za-z0-9_]+[:=]//g' FILE > FILE.csv, and write [format] "
                   "header_line = 0 and names = [" +
                       names + "] into campaign.toml"};
}

// UTF-32 if three of four bytes are 0, always on the same side.
std::optional<TextEncoding> utf32_of(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE\0\0"sv)) return TextEncoding::utf32_le;
  if (bytes.starts_with("\0\0\xFE\xFF"sv)) return TextEncoding::utf32_be;
  std::array<std::size_t, 4> zeros{};
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (bytes[i] == '\0') ++zeros[i % 4];
  const std::size_t most = bytes.size() / 5;  // nearly a quarter of all
  if (zeros[1] < most || zeros[2] < most) return std::nullopt;
  if (zeros[3] >= most && zeros[0] * 10 < zeros[3]) return TextEncoding::utf32_le;
  if (zeros[0] >= most && zeros[3] * 10 < zeros[0]) return TextEncoding::utf32_be;
  return std::nullopt;
}

TextEncoding encoding_of(std::string_view bytes) {
  if (const auto wide = utf32_of(bytes)) return *wide;
  if (bytes.starts_with("\xFF\xFE"sv)) return TextEncoding::utf16_le;
  if (bytes.starts_with("\xFE\xFF"sv)) return TextEncoding::utf16_be;
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (bytes[i] == '\0') ++zeros[i % 2];
  // In UTF-16 digits and separators have one zero byte each, always on the same side.
  if (zeros[1] * 3 > bytes.size() && zeros[0] * 10 < zeros[1]) return TextEncoding::utf16_le;
  if (zeros[0] * 3 > bytes.size() && zeros[1] * 10 < zeros[0]) return TextEncoding::utf16_be;
  return is_utf8(bytes) ? TextEncoding::utf8 : code_page_of(bytes);
}

std::string utf8_from(std::string_view bytes, TextEncoding encoding) {
  switch (encoding) {
    case TextEncoding::utf16_le:
      return from_utf16(bytes, false);
    case TextEncoding::utf16_be:
      return from_utf16(bytes, true);
    case TextEncoding::utf32_le:
      return from_utf32(bytes, false);
    case TextEncoding::utf32_be:
      return from_utf32(bytes, true);
    case TextEncoding::windows_1252:
    case TextEncoding::windows_1251:
    case TextEncoding::mac_roman:
      return from_code_page(bytes, encoding);
    case TextEncoding::utf8:
      break;
  }
  return std::string(bytes);
}

TextLines::TextLines(std::istream& in, std::optional<TextEncoding> encoding, std::size_t ahead)
    : in_(in), encoding_(TextEncoding::utf8) {
  held_.resize(kLookedAt);
  in_.read(held_.data(), static_cast<std::streamsize>(held_.size()));
  held_.resize(static_cast<std::size_t>(in_.gcount()));
  first_bytes_ = held_.substr(0, 32);
  encoding_ = encoding.value_or(encoding_of(held_));
  if (is_wide(encoding_)) {
    held_.append(std::istreambuf_iterator<char>(in_), {});
    held_ = utf8_from(held_, encoding_);
  }
  if (held_.starts_with(kByteOrderMark)) held_.erase(0, kByteOrderMark.size());
  is_old_mac_ = held_.find('\n') == std::string::npos && held_.find('\r') != std::string::npos;
  std::string line;
  while (ahead_.size() < ahead && read(line)) ahead_.push_back(line);
  join_broken_names();
}

// Joins names with a line break within quotes ("Load<line break>(N)" of a spreadsheet). The cells go into the
// first of the lines; the others become empty, so that the lines keep their numbers.
void TextLines::join_broken_names() {
  const auto is_open = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '"') % 2 == 1;
  };
  for (std::size_t i = 0; i + 1 < ahead_.size(); ++i) {
    if (!is_open(ahead_[i])) continue;
    std::string joined = ahead_[i];
    std::size_t last = i;
    const std::size_t most = std::min(ahead_.size() - 1, i + kMostBreaks);
    while (last < most && is_open(joined)) joined += ' ' + ahead_[++last];
    if (is_open(joined)) continue;  // an inch sign, or a quote without an end
    ahead_[i] = joined;
    for (std::size_t k = i + 1; k <= last; ++k) ahead_[k].clear();
    i = last;
  }
}

bool TextLines::next(std::string& line) {
  if (ahead_.empty()) return read(line);
  line = std::move(ahead_.front());
  ahead_.pop_front();
  return true;
}

bool TextLines::raw_line(std::string& line) {
  const char end = is_old_mac_ ? '\r' : '\n';
  if (at_ < held_.size()) {
    const auto stop = held_.find(end, at_);
    line = held_.substr(at_, stop == std::string::npos ? stop : stop - at_);
    at_ = stop == std::string::npos ? held_.size() : stop + 1;
    last_is_ended_ = stop != std::string::npos;
    if (stop != std::string::npos || !in_) return true;
    std::string rest;  // the line continues after the bytes already read
    if (std::getline(in_, rest, end)) line += rest, last_is_ended_ = !in_.eof();
    return true;
  }
  if (!held_.empty()) std::string().swap(held_), at_ = 0;
  const bool is_there = static_cast<bool>(std::getline(in_, line, end));
  if (is_there) last_is_ended_ = !in_.eof();
  return is_there;
}

bool TextLines::read(std::string& line) {
  if (!raw_line(line)) return false;
  while (line.ends_with('\r')) line.pop_back();
  // A file whose space was allocated beforehand (SD card) ends in zeros.
  if (!is_wide(encoding_)) std::erase(line, '\0');
  const auto has_high_byte = [&] {
    return std::any_of(line.begin(), line.end(), [](char c) { return (c & 0x80) != 0; });
  };
  const bool is_page = !is_wide(encoding_) && encoding_ != TextEncoding::utf8;
  if (is_page)
    line = utf8_from(line, encoding_);
  else if (encoding_ == TextEncoding::utf8 && has_high_byte() && !is_utf8(line))
    line = utf8_from(line, TextEncoding::windows_1252);
  return true;
}

std::optional<OtherText> other_content_of(const TextLines& lines) {
  if (const auto binary = binary_format_of(lines.first_bytes()))
    return OtherText{std::string(binary->name), std::string(binary->cure)};
  for (const auto& line : lines.ahead())
    if (!trimmed_cell(line).empty()) return other_text_of(line);
  return std::nullopt;
}

}  // namespace sandhopper
