#include "tools/campaign/table_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/hint.hpp"

namespace sandhopper {
namespace {

using Kind = ConfigNode::Kind;

struct Word {
  std::string_view text;
  char value;
};
constexpr std::array kSeparators{Word{",", ','},     Word{";", ';'}, Word{"tab", '\t'}, Word{"\t", '\t'},
                                 Word{"blank", ' '}, Word{" ", ' '}, Word{"|", '|'}};
constexpr std::array kDecimals{Word{".", '.'}, Word{",", ','}};
constexpr std::array kThousands{Word{"", '\0'}, Word{".", '.'}, Word{",", ','}, Word{"'", '\''},
                                Word{" ", ' '}};

class FormatReader {
 public:
  explicit FormatReader(CsvFormat& format) : format_(format) {}

  void read(const ConfigNode& node) {
    if (node.key == "separator") return one_of(node, kSeparators, format_.separator);
    if (node.key == "decimal") return one_of(node, kDecimals, format_.decimal);
    if (node.key == "thousands") return one_of(node, kThousands, format_.thousands);
    if (node.key == "encoding") return encoding(node);
    if (node.key == "header_line") return line(node, format_.header_line);
    if (node.key == "units_line") return line(node, format_.units_line);
    if (node.key == "names") return words(node, format_.names);
    if (node.key == "no_sample") return words(node, format_.no_sample);
    if (node.key == "clock") return clock(node);
    if (node.key == "day_first" && node.kind == Kind::boolean) {
      format_.day_first = node.boolean;
      return;
    }
    if (node.key == "row_every_s") return above_0(node, "time between two rows, in s", format_.row_every_s);
    if (node.key == "frames_per_s")
      return above_0(node, "number of frames in a second", format_.frames_per_s);
    if (node.key == "time_restarts_at")
      return above_0(node, "time at which the column begins again at 0", format_.time_restarts_at);
    if (node.key == "spread_times" && node.kind == Kind::boolean) {
      format_.spread_times = node.boolean;
      return;
    }
    static const std::vector<std::string> kKeys{"separator",    "decimal",         "thousands", "encoding",
                                                "header_line",  "units_line",      "names",     "no_sample",
                                                "spread_times", "clock",           "day_first", "row_every_s",
                                                "frames_per_s", "time_restarts_at"};
    wrong(node, cure_for_unknown_key(node.key, std::nullopt, kKeys));
  }
  std::vector<ConfigProblem> take_problems() { return std::move(problems_); }

 private:
  void wrong(const ConfigNode& node, const std::string& text) {
    problems_.push_back({"", node.key_position, "format." + node.key, text});
  }

  template <std::size_t N>
  void one_of(const ConfigNode& node, const std::array<Word, N>& words, std::optional<char>& out) {
    for (const auto& word : words)
      if (node.kind == Kind::text && word.text == node.text) {
        out = word.value;
        return;
      }
    std::vector<std::string_view> known;
    for (const auto& word : words)
      if (word.text != "\t") known.push_back(word.text);
    wrong(node, fmt::format("is none of \"{}\"", fmt::join(known, "\", \"")));
  }

  void encoding(const ConfigNode& node) {
    const auto& names = EnumNames<TextEncoding>::value;
    const auto found = std::find(names.begin(), names.end(), node.text);
    if (node.kind != Kind::text || found == names.end())
      return wrong(node, fmt::format("is none of \"{}\"", fmt::join(names, "\", \"")));
    format_.encoding = static_cast<TextEncoding>(found - names.begin());
  }

  void line(const ConfigNode& node, std::optional<std::uint64_t>& out) {
    if (node.kind != Kind::integer || node.integer < 0)
      return wrong(node, "is no number of a line: from 1; 0 for none");
    out = static_cast<std::uint64_t>(node.integer);
  }

  void clock(const ConfigNode& node) {
    if (node.kind != Kind::text || (node.text != "mm:ss" && node.text != "hh:mm"))
      return wrong(node, "is neither \"mm:ss\" nor \"hh:mm\"");
    format_.minutes_first = node.text == "mm:ss";
  }

  void above_0(const ConfigNode& node, std::string_view what, double& out) {
    const double value = node.kind == Kind::real      ? node.real
                         : node.kind == Kind::integer ? static_cast<double>(node.integer)
                                                      : 0.0;
    if (!(value > 0.0)) return wrong(node, fmt::format("is no {}", what));
    out = value;
  }

  void words(const ConfigNode& node, std::vector<std::string>& out) {
    const bool texts =
        node.kind == Kind::array && std::all_of(node.children.begin(), node.children.end(),
                                                [](const auto& child) { return child.kind == Kind::text; });
    if (!texts) return wrong(node, "is no list of texts: write [\"one\", \"two\"]");
    out.clear();
    for (const auto& child : node.children) out.push_back(child.text);
  }

  CsvFormat& format_;
  std::vector<ConfigProblem> problems_;
};

}  // namespace

std::vector<ConfigProblem> read_format(const ConfigNode& table, CsvFormat& format) {
  FormatReader reader(format);
  for (const auto& child : table.children) reader.read(child);
  return reader.take_problems();
}

}  // namespace sandhopper
