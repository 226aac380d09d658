#include "tools/faults/pair_table.hpp"

#include <fmt/format.h>

#include <array>

namespace sandhopper::faults {
namespace {

constexpr std::array kClasses{"motor", "bus",   "imu",      "tof",    "load_cell",
                              "estop", "robot", "computer", "restart"};

// Left and right motor share a row, and so do body and foot IMU.
std::string row_of(const Cell& cell) {
  if (cell.kind == Kind::limit) return "limit " + std::string(name_of(cell.expected));
  return class_of(cell) + " " + std::string(name_of(cell.kind));
}

void add_to(PairTable::Count& count, const PairResult& result) {
  ++count.pairs;
  count.hidden += !result.hidden.empty();
  count.wrong += !result.problem.empty();
}

}  // namespace

void PairTable::add(const Pair& pair, const PairResult& result) {
  add_to(rows_[row_of(pair.first)][class_of(pair.second)], result);
  add_to(total_, result);
}

std::vector<std::string> PairTable::lines() const {
  std::string head = fmt::format("{:<32}", "first \\ second");
  for (const auto* name : kClasses) head += fmt::format(" {:>9}", name);
  std::vector<std::string> lines{head};
  for (const auto& [first, row] : rows_) {
    std::string line = fmt::format("{:<32}", first);
    for (const auto* name : kClasses) {
      const auto found = row.find(name);
      const Count count = found == row.end() ? Count{} : found->second;
      line += fmt::format(" {:>9}", count.wrong > 0   ? fmt::format("{}/{} !", count.wrong, count.pairs)
                                    : count.pairs > 0 ? std::to_string(count.pairs)
                                                      : "-");
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace sandhopper::faults
