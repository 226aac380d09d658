#include "tools/campaign/cell_forms.hpp"

#include <algorithm>
#include <array>

#include "firmware/log/csv_cells.hpp"
#include "firmware/log/csv_time_code.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kDigits = "0123456789";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_number(std::string_view text) {
  text = trimmed_cell(text);
  return !text.empty() && text.find_first_of(kDigits) != std::string_view::npos &&
         (number_in_cell(text, {'.', '\0'}) || number_in_cell(text, {',', '\0'}));
}

std::string sed(std::string_view script) { return "sed -E '" + std::string(script) + "' FILE > FILE.csv"; }

// Length of the longest number with which the text begins; 0 without one.
std::size_t number_at_start(std::string_view text) {
  std::size_t length = std::min(text.find_first_not_of("0123456789.,+-eE"), text.size());
  while (length > 0 && !is_number(text.substr(0, length))) --length;
  return length;
}

// "[1.2]", "(1.2,)", "array([1.2])", "np.float64(1.2)". Brackets alone, "(1.2)", are left to accounting.
std::optional<CellForm> python_array(std::string_view cell) {
  const auto open = cell.find_first_of("[(");
  if (open == std::string_view::npos) return std::nullopt;
  const auto name = cell.substr(0, open);
  if (!std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c) || c == '.' || c == '_'; }))
    return std::nullopt;
  const auto first = cell.find_first_not_of("[( ", open), last = cell.find_last_not_of("]), ");
  if (first == std::string_view::npos || last == std::string_view::npos || last < first ||
      last + 1 == cell.size())
    return std::nullopt;
  const auto inside = cell.substr(first, last + 1 - first);
  if (is_number(inside))
    return CellForm{name.empty() ? "an array of one number as Python prints it"
                                 : "a number with its type as Python prints it",
                    "write the number itself, float(x) or x.item(), or take the rest away: " +
                        sed(R"(s/[A-Za-z_.0-9]*[[(]+ *([-+0-9.eE]+),? *[])]+/\1/g)")};
  const auto begin = number_at_start(inside);
  if (begin == 0 || (inside[begin] != ' ' && inside[begin] != ',' && inside[begin] != ';'))
    return std::nullopt;
  return CellForm{"a list of several numbers", "give each of its numbers a column of its own"};
}

std::optional<CellForm> python_bytes(std::string_view cell) {
  if (cell.size() < 4 || !cell.starts_with("b'") || !cell.ends_with('\'')) return std::nullopt;
  if (!is_number(cell.substr(2, cell.size() - 3))) return std::nullopt;
  return CellForm{
      "bytes as Python prints them",
      "decode them before writing, x.decode(), or take the rest away: sed -E \"s/b'([^']*)'/\\1/g\" "
      "FILE > FILE.csv"};
}

std::optional<CellForm> complex_number(std::string_view cell) {
  if (cell.starts_with('(') && cell.ends_with(')')) cell = cell.substr(1, cell.size() - 2);
  if (cell.size() < 4 || (cell.back() != 'j' && cell.back() != 'i')) return std::nullopt;
  for (std::size_t sign = 1; sign + 1 < cell.size(); ++sign)
    if ((cell[sign] == '+' || cell[sign] == '-') && is_number(cell.substr(0, sign)) &&
        is_number(cell.substr(sign, cell.size() - sign - 1)))
      return CellForm{"a complex number", "write its real part alone, in Python x.real"};
  return std::nullopt;
}

std::optional<CellForm> with_uncertainty(std::string_view cell) {
  for (const std::string_view sign : {"\xC2\xB1", "+/-", "+-"}) {
    const auto at = cell.find(sign);
    if (at != std::string_view::npos && at > 0 && is_number(cell.substr(0, at)) &&
        is_number(cell.substr(at + sign.size())))
      return CellForm{"a value with its uncertainty",
                      "give the uncertainty a column of its own, or take it away: " +
                          sed("s/ *(\xC2\xB1|\\+\\/-|\\+-) *[0-9.]+//g")};
  }
  return std::nullopt;
}

std::optional<CellForm> bound(std::string_view cell) {
  for (const std::string_view sign : {"<=", ">=", "<", ">", "\xE2\x89\xA4", "\xE2\x89\xA5"})
    if (cell.starts_with(sign) && is_number(cell.substr(sign.size())))
      return CellForm{"a bound and no measured value", "leave the cell empty where nothing was measured"};
  for (const std::string_view sign : {"~", "\xE2\x89\x88", "ca. ", "ca."})
    if (cell.starts_with(sign) && is_number(cell.substr(sign.size())))
      return CellForm{"a value that is only about right", "write the measured number alone"};
  return std::nullopt;
}

std::optional<CellForm> power_of_ten(std::string_view cell) {
  const auto length = number_at_start(cell);
  if (length == 0) return std::nullopt;
  auto rest = cell.substr(length);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  for (const std::string_view sign : {"x", "X", "*", "\xC3\x97", "\xC2\xB7"}) {
    if (!rest.starts_with(sign)) continue;
    rest.remove_prefix(sign.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    if (!rest.starts_with("10")) return std::nullopt;
    return CellForm{"a number with its power of ten written out",
                    "write it as 1.2e-3: " + sed("s/([0-9]) *(x|X|[*]|\xC3\x97|\xC2\xB7) *10\\^?/\\1e/g")};
  }
  return std::nullopt;
}

std::optional<CellForm> hexadecimal(std::string_view cell) {
  const bool begins = cell.starts_with("0x") || cell.starts_with("0X");
  if (!begins || cell.size() < 3 ||
      cell.find_first_not_of("0123456789abcdefABCDEF", 2) != std::string_view::npos)
    return std::nullopt;
  return CellForm{
      "a hexadecimal number",
      "write decimal numbers, in Python int(x, 16); if the number has a sign, its largest bit counts "
      "negative"};
}

// "3/8", "1 3/8", "1-3/8".
std::optional<CellForm> fraction(std::string_view cell) {
  const auto slash = cell.find('/');
  if (slash == std::string_view::npos || slash == 0 || slash + 1 == cell.size() ||
      cell.find_first_not_of("0123456789 -/") != std::string_view::npos ||
      cell.find('/', slash + 1) != std::string_view::npos || !is_digit(cell[slash - 1]) ||
      !is_digit(cell.back()))
    return std::nullopt;
  return CellForm{"a fraction", "write decimal numbers, 0.375 for 3/8"};
}

std::optional<CellForm> degrees_and_minutes(std::string_view cell) {
  constexpr std::string_view kDegree = "\xC2\xB0";
  const auto at = cell.find(kDegree);
  if (at == std::string_view::npos || !is_number(cell.substr(0, at))) return std::nullopt;
  const auto rest = cell.substr(at + kDegree.size());
  if (rest.find_first_of(kDigits) == std::string_view::npos) return std::nullopt;
  return CellForm{"an angle in degrees and minutes", "write decimal degrees, 12.5 for 12\xC2\xB0 30'"};
}

// Digits of Arabic, Persian and Devanagari.
std::optional<CellForm> other_digits(std::string_view cell) {
  for (std::size_t i = 0; i + 1 < cell.size(); ++i) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(cell[i + k]); };
    const bool arabic = byte(0) == 0xD9 && byte(1) >= 0xA0 && byte(1) <= 0xA9;
    const bool persian = byte(0) == 0xDB && byte(1) >= 0xB0 && byte(1) <= 0xB9;
    const bool devanagari =
        i + 2 < cell.size() && byte(0) == 0xE0 && byte(1) == 0xA5 && byte(2) >= 0xA6 && byte(2) <= 0xAF;
    if (arabic || persian || devanagari)
      return CellForm{
          "a number in the digits of another script",
          "write the digits 0 to 9: set the format of the cells, or the language of the program, to "
          "English before saving"};
  }
  return std::nullopt;
}

// A number in quotes, or with blanks, that is one as soon as they are taken away.
std::optional<CellForm> disguised(std::string_view cell) {
  constexpr std::array<std::string_view, 3> kBlanks{"\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89"};
  std::string plain(cell);
  for (const auto blank : kBlanks)
    for (auto at = plain.find(blank); at != std::string::npos; at = plain.find(blank))
      plain.replace(at, blank.size(), " ");
  const bool has_blanks = plain.find(' ') != std::string::npos;
  std::string bare = plain;
  std::erase(bare, '"');
  if (bare != plain && is_number(bare))
    return CellForm{"a number in quotes within quotes", "take the quotes away: " + sed("s/\"//g")};
  std::erase(bare, ' ');
  if (has_blanks && is_number(bare))
    return CellForm{"a number with a blank in it",
                    "take the blank away: " + sed("s/([0-9eE+-])[ \xC2\xA0]+([-+0-9eE]|[,;]|$)/\\1\\2/g")};
  return std::nullopt;
}

// "10:00:00;12": with colons alone it would be read as a time of day.
std::optional<CellForm> time_code(std::string_view cell) {
  const auto code = time_code_in(cell);
  if (!code || !code->drops_frames) return std::nullopt;
  return CellForm{"a time code that drops frames",
                  "write [format] frames_per_s = 29.97003 (30000/1001), or 59.94006, into campaign.toml"};
}

// "11:59:59 a. m.": a time of day beside words.
std::optional<CellForm> time_with_words(std::string_view cell) {
  const auto first = cell.find_first_of(kDigits), last = cell.find_last_of(kDigits);
  if (first == std::string_view::npos || (first == 0 && last + 1 == cell.size())) return std::nullopt;
  const auto time = cell.substr(first, last + 1 - first);
  if (time.find(':') == std::string_view::npos || !time_in_cell(time)) return std::nullopt;
  return CellForm{
      "a time of day with words other than AM and PM",
      "write AM and PM, or hours from 0 to 23: " + sed("s/ *a[.] ?m[.]/ AM/g; s/ *p[.] ?m[.]/ PM/g")};
}

// "F=1.2", "F: 1.2".
std::optional<CellForm> with_name(std::string_view cell) {
  const auto sign = cell.find_first_of("=:");
  if (sign == std::string_view::npos || sign == 0 || !is_number(cell.substr(sign + 1)) ||
      !std::all_of(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(sign),
                   [](char c) { return is_letter(c) || c == '_' || c == ' '; }))
    return std::nullopt;
  return CellForm{"a number behind a name",
                  "take the name away: " + sed(R"(s/[A-Za-z_]+ *[=:] *([-+0-9.])/\1/g)")};
}

// Something behind a number that is no number itself: a unit, a type of C, a mark.
std::optional<CellForm> with_tail(std::string_view cell) {
  const auto length = number_at_start(cell);
  if (length == 0 || length == cell.size()) return std::nullopt;
  const auto tail = trimmed_cell(cell.substr(length));
  if (tail.empty() || tail.find_first_of(kDigits) == 0) return std::nullopt;
  if (tail == "%")
    return CellForm{"a share in per cent",
                    "write the numbers without % and state the unit, and as scale what 1 % is in it: " +
                        sed(R"(s/([0-9]) *%/\1/g)")};
  const bool is_typed = tail.size() == 1 && cell[length] != ' ' &&
                        std::string_view("fFlL").find(tail[0]) != std::string_view::npos;
  if (is_typed)
    return CellForm{"a number with its type of the language C, or a letter for a unit, behind it",
                    "take the letter away: " + sed(R"(s/([0-9.])[fFlL]([^A-Za-z]|$)/\1\2/g)")};
  if (tail.find_first_not_of("*?!#") == std::string_view::npos)
    return CellForm{"a number with a mark behind it",
                    "if the mark means a doubtful reading leave the cell empty, else take it away: " +
                        sed(R"(s/([0-9])[*?!#]+/\1/g)")};
  const bool is_word = is_letter(tail.front()) || (tail.front() & 0x80) != 0;
  if (!is_word || tail.find_first_of(kDigits) != std::string_view::npos) return std::nullopt;
  return CellForm{
      "a number with \"" + printable_cell(tail) + "\" behind it",
      "if the cells hold a unit or a prefix (k, m) behind the number, write the unit into the column's "
      "name and numbers alone below it"};
}

std::optional<CellForm> with_unit_before(std::string_view cell) {
  const auto length = std::min(cell.find_first_of("0123456789+-."), cell.size());
  if (length == 0 || length > 4 || !is_number(cell.substr(length)) ||
      !std::all_of(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(length),
                   [](char c) { return is_letter(c) || c == ' ' || c == '$'; }))
    return std::nullopt;
  return CellForm{"a number with \"" + std::string(trimmed_cell(cell.substr(0, length))) + "\" before it",
                  "if that is a unit, write it into the column's name and numbers alone below it"};
}

}  // namespace

std::optional<CellForm> form_of_cell(std::string_view cell) {
  cell = trimmed_cell(cell);
  if (cell.starts_with('(') && cell.ends_with(')') && is_number(cell.substr(1, cell.size() - 2)))
    return std::nullopt;  // accounting
  using Look = std::optional<CellForm> (*)(std::string_view);
  constexpr std::array<Look, 16> kLooks{time_code,      time_with_words,  python_array, python_bytes,
                                        complex_number, with_uncertainty, bound,        hexadecimal,
                                        power_of_ten,   fraction,         other_digits, degrees_and_minutes,
                                        disguised,      with_name,        with_tail,    with_unit_before};
  for (const auto look : kLooks)
    if (auto form = look(cell)) return form;
  return std::nullopt;
}

}  // namespace sandhopper
