#include "tools/campaign/second_cells.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/campaign/column_guess.hpp"
#include "tools/campaign/column_rivals.hpp"
#include "tools/campaign/signal_noise.hpp"
#include "tools/campaign/used_column.hpp"
#include "tools/campaign/vector_axes.hpp"

namespace sandhopper {
namespace {

constexpr std::array<std::string_view, 2> kForces{"force_N", "load_cell_force_N"};

// Numbers and words of a name: "Fz1 (N)" gives fz, 1, n.
std::vector<std::string> parts_of_name(std::string_view name) {
  const auto kind = [](char c) {
    if (c >= '0' && c <= '9') return 1;
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80) != 0;
    return is_letter ? 2 : 0;
  };
  std::vector<std::string> parts;
  int before = 0;
  for (const char c : name) {
    const int now = kind(c);
    if (now != 0 && now != before) parts.emplace_back();
    if (now != 0) parts.back() += in_lower_case({&c, 1});
    before = now;
  }
  return parts;
}

bool is_index(const std::string& part) {
  constexpr std::array<std::string_view, 22> kSides{
      "left", "right", "front", "back",   "rear", "top",    "bottom", "upper",  "lower", "inner", "outer",
      "main", "aux",   "links", "rechts", "vorn", "hinten", "gauche", "droite", "oben",  "unten", "mitte"};
  const bool is_number = part.find_first_not_of("0123456789") == std::string::npos;
  const bool is_letter = part.size() == 1 && (part[0] < 'x' || part[0] > 'z');
  return is_number || is_letter || std::ranges::find(kSides, part) != kSides.end();
}

// other = a + slope * one by least squares.
struct Relation {
  double slope = 0.0, correlation = 0.0, residual = 0.0;
  std::size_t rows = 0;
};
Relation relation_of(const std::vector<double>& one, const std::vector<double>& other) {
  Relation relation;
  double x = 0.0, y = 0.0;
  const auto is_row = [&](std::size_t row) { return !std::isnan(one[row]) && !std::isnan(other[row]); };
  for (std::size_t row = 0; row < one.size(); ++row)
    if (is_row(row)) x += one[row], y += other[row], ++relation.rows;
  if (relation.rows == 0) return relation;
  const auto n = static_cast<double>(relation.rows);
  x /= n, y /= n;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t row = 0; row < one.size(); ++row)
    if (is_row(row)) {
      const double dx = one[row] - x, dy = other[row] - y;
      xx += dx * dx, xy += dx * dy, yy += dy * dy;
    }
  if (!(xx > 0.0) || !(yy > 0.0)) return relation;
  relation.slope = xy / xx;
  relation.correlation = xy / std::sqrt(xx * yy);
  relation.residual = std::sqrt(std::max(0.0, yy - xy * xy / xx) / n);
  return relation;
}

// Fisher's z of a correlation, in its standard deviations.
double significance(const Relation& relation) {
  if (relation.rows < 10) return 0.0;
  const double r = std::min(std::abs(relation.correlation), 1.0 - 1e-12);
  return std::atanh(r) * std::sqrt(static_cast<double>(relation.rows) - 3.0);
}

class Finder {
 public:
  Finder(const CsvTable& table, const std::string& file, const Campaign& campaign, const CampaignTrial& trial)
      : table_(table), file_(file), campaign_(campaign), trial_(trial) {}

  std::optional<Finding> run() {
    for (const auto channel : kForces) {
      if (find_channel(campaign_.plant, channel) == nullptr) continue;
      const auto* mapping = mapping_of(trial_, channel);
      const std::string name = mapping == nullptr ? std::string(channel) : mapping->column;
      const auto* column = find_column(table_, name);
      if (column == nullptr || (mapping != nullptr && mapping->is_stated())) continue;
      if (auto finding =
              look_beside(channel, static_cast<std::size_t>(column - table_.columns.data()), mapping))
        return finding;
    }
    return std::nullopt;
  }

 private:
  static bool reads(const std::vector<ColumnMapping>& columns, const std::string& name) {
    return std::ranges::any_of(columns, [&](const ColumnMapping& mapping) {
      return mapping.column == name || mapping.plus.column == name ||
             std::ranges::find(mapping.added, name) != mapping.added.end();
    });
  }
  // Columns that this trial, or another one of the same file, reads.
  bool is_read(const std::string& name) const {
    return reads(trial_.columns, name) ||
           std::ranges::any_of(campaign_.trials, [&](const CampaignTrial& trial) {
             return trial.file == trial_.file && reads(trial.columns, name);
           });
  }

  bool may_be_cell(std::size_t i, std::size_t force) const {
    const auto& name = table_.names[i];
    if (i == force || is_read(name) || is_setpoint_by_name(name) || is_filtered_by_name(name) ||
        find_channel(campaign_.plant, name) != nullptr)
      return false;
    const auto axes = axes_of(table_, force);
    if (std::ranges::find(axes.columns, i) != axes.columns.end()) return false;
    const auto own = unit_of_column(table_, force), other = unit_of_column(table_, i);
    if (!own && !other) return are_named_alike(table_.names[force], name);
    if (!own || !other || !factor_between(*other, *own)) return false;
    return own->dimension == "force" || are_named_alike(table_.names[force], name);
  }

  bool is_loaded_with(std::size_t i, std::size_t force) const {
    constexpr double kClear = 5.0;   // in standard deviations
    constexpr double kShare = 0.01;  // of the force, as for a force above the surface (surface_check)
    const auto& one = table_.columns[force];
    const auto& other = table_.columns[i];
    const auto relation = relation_of(one, other);
    const auto own = unit_of_column(table_, force), its = unit_of_column(table_, i);
    const double factor = own && its ? factor_between(*its, *own).value_or(1.0) : 1.0;
    if (significance(relation) < kClear || std::abs(relation.slope) * factor < kShare) return false;
    // A copy: the same force within the digits, perhaps in another unit or with another zero.
    const double digits = digit_of(other) + std::abs(relation.slope) * digit_of(one);
    const bool is_copy = std::abs(relation.slope * factor - 1.0) < kSameScale && relation.residual <= digits;
    return !is_copy;
  }

  std::optional<Finding> look_beside(std::string_view channel, std::size_t force,
                                     const ColumnMapping* mapping) const {
    std::vector<std::string> cells;
    bool are_alike = true;
    for (std::size_t i = 0; i < table_.names.size(); ++i)
      if (may_be_cell(i, force) && is_loaded_with(i, force)) {
        cells.push_back(table_.names[i]);
        are_alike &= are_named_alike(table_.names[force], table_.names[i]);
      }
    if (cells.empty()) return std::nullopt;
    const auto& name = table_.names[force];
    auto all = mapping == nullptr ? std::vector<std::string>{} : mapping->added;
    all.insert(all.end(), cells.begin(), cells.end());
    const auto unit = unit_of_column(table_, force);
    const auto unit_text = unit ? toml_text(unit->text) : std::string("\"…\"");
    return Finding{
        FindingKind::set_up,
        are_alike ? FindingSeverity::trial_unusable : FindingSeverity::note,
        file_,
        std::max<std::uint64_t>(table_.layout.header_line, 1),
        1,
        name,
        fmt::format(
            "for {}: {} {} loaded together with it: several load cells that carry the foot together, or "
            "the same force measured again",
            channel, fmt::join(cells, ", "), cells.size() == 1 ? "is" : "are"),
        fmt::format(
            "if they carry it together add them: {} = {{ column = {}, unit = {} }} in [columns]; if this "
            "column is the whole force state unit and scale together: {} = {{ column = {}, unit = {}, scale "
            "= … }}",
            channel, column_text(name, all), unit_text, channel, toml_text(name), unit_text)};
  }

  const CsvTable& table_;
  const std::string& file_;
  const Campaign& campaign_;
  const CampaignTrial& trial_;
};

}  // namespace

bool are_named_alike(std::string_view one, std::string_view other) {
  const auto a = parts_of_name(one), b = parts_of_name(other);
  if (a.size() != b.size()) return false;
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (!is_index(a[i]) || !is_index(b[i])) return false;
    ++different;
  }
  return different == 1;
}

std::optional<Finding> second_cell(const CsvTable& table, const std::string& file, const Campaign& campaign,
                                   const CampaignTrial& trial) {
  return Finder(table, file, campaign, trial).run();
}

}  // namespace sandhopper
