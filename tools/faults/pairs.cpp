#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/faults/pair.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::array kPairPhases{Phase::armed, Phase::flight, Phase::compression, Phase::extension};
// Delays relative to the reaction, which damps for one second: in its first cycle, early in it, and in its
// middle.
constexpr std::array kDelays_cycles{kTogether, 1, 20, 400};

// A cell of the computer that raises no fault when it comes alone. A restart is only used as second fault.
Cell harmless(Kind kind, Phase phase) {
  return {.device = Device::computer, .kind = kind, .phase = phase, .expected = Fault::none};
}

bool is_imu(Device device) { return device == Device::imu_body || device == Device::imu_foot; }

// A second fault of the same device replaces the first, so such a pair is never planted in the same cycle.
bool share_a_device(const Cell& a, const Cell& b) {
  if (a.device == Device::computer || a.kind == Kind::limit || b.kind == Kind::limit) return false;
  return a.device == b.device || (a.device == Device::robot && is_imu(b.device)) ||
         (is_imu(a.device) && b.device == Device::robot);
}

// A reply with the supply voltage has no field for the temperature and the error code.
bool has_no_room(const Cell& a, const Cell& b) {
  const auto needs = [](Kind kind) {
    return kind == Kind::error || kind == Kind::hot || kind == Kind::announced_loss;
  };
  return (a.kind == Kind::undervoltage && needs(b.kind)) || (b.kind == Kind::undervoltage && needs(a.kind));
}

bool same_defect(const Cell& a, const Cell& b) { return a.device == b.device && a.kind == b.kind; }

// A defect with its cell in each phase; nullptr: it cannot be planted or seen in that phase.
struct Defect {
  std::array<const Cell*, kPairPhases.size()> cell{};
  const Cell& any() const {
    return **std::ranges::find_if(cell, [](const Cell* c) { return c != nullptr; });
  }
};

std::vector<Defect> defects_of(const std::vector<Cell>& cells) {
  std::vector<Defect> defects;
  for (const auto& cell : cells) {
    const auto phase = std::ranges::find(kPairPhases, cell.phase);
    if (phase == kPairPhases.end()) continue;
    auto known = std::ranges::find_if(
        defects, [&](const Defect& d) { return same_defect(d.any(), cell) && cell.kind != Kind::limit; });
    if (known == defects.end()) known = defects.insert(defects.end(), Defect{});
    known->cell[static_cast<std::size_t>(phase - kPairPhases.begin())] = &cell;
  }
  return defects;
}

class Pairs {
 public:
  std::vector<Pair> take() { return std::move(pairs_); }

  void add(const Defect& first, const Defect& second) {
    if (second.any().kind == Kind::limit || same_defect(first.any(), second.any()) ||
        has_no_room(first.any(), second.any()))
      return;
    const auto start = pairs_.size();
    for (std::size_t i = 0; i < kPairPhases.size(); ++i) {
      const auto phase = (start + i) % kPairPhases.size();
      const Cell *const a = first.cell[phase], *const b = second.cell[phase];
      if (a == nullptr || b == nullptr || a->expected == Fault::none) continue;
      const bool apart = a->kind == Kind::limit || share_a_device(*a, *b);
      const auto delay = (start / kPairPhases.size()) % kDelays_cycles.size();
      pairs_.push_back({*a, *b, kDelays_cycles[apart && delay == 0 ? 1 : delay]});
      return;
    }
  }

  // Pairs the defect, in both orders, with a fault of the computer that is in no cell of the matrix.
  void add_harmless(const Defect& defect, Kind kind) {
    const auto start = pairs_.size();
    for (std::size_t i = 0; i < kPairPhases.size(); ++i) {
      const Cell* const cell = defect.cell[(start + i) % kPairPhases.size()];
      if (cell == nullptr || cell->expected == Fault::none) continue;
      const int delay = kDelays_cycles[1 + start % (kDelays_cycles.size() - 1)];
      pairs_.push_back({*cell, harmless(kind, cell->phase), delay});
      if (cell->kind != Kind::limit) pairs_.push_back({harmless(kind, cell->phase), *cell, delay});
      return;
    }
  }

  // A restart after the defect: once while armed, so that the new session can arm, and once in flight.
  void add_restarts(const Defect& defect) {
    for (std::size_t phase = 0; phase < 2; ++phase)
      if (const Cell* const cell = defect.cell[phase]; cell != nullptr)
        pairs_.push_back({*cell, harmless(Kind::restart, cell->phase), kDelays_cycles[1 + phase]});
  }

 private:
  std::vector<Pair> pairs_;
};

}  // namespace

std::string Pair::name() const {
  const auto when =
      delay_cycles == kTogether ? "together with" : fmt::format("{} cycles later", delay_cycles);
  return fmt::format("{} in {}, {} {}", first.name(), name_of(first.phase), when, second.name());
}

std::vector<Pair> all_pairs() {
  const auto cells = all_cells();
  const auto defects = defects_of(cells);
  Pairs pairs;
  for (const auto& first : defects)
    for (const auto& second : defects) pairs.add(first, second);
  for (const auto& defect : defects) {
    pairs.add_harmless(defect, Kind::clock_step);
    pairs.add_harmless(defect, Kind::disk_full);
    pairs.add_restarts(defect);
  }
  return pairs.take();
}

std::vector<Pair> some_pairs(std::size_t count, std::uint64_t seed) {
  auto pairs = all_pairs();
  Random random(seed, 1);
  count = std::min(count, pairs.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = static_cast<double>(pairs.size() - i);
    std::swap(pairs[i], pairs[i + static_cast<std::size_t>(random.uniform() * left)]);
  }
  pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(count), pairs.end());
  return pairs;
}

std::string class_of(const Cell& cell) {
  switch (cell.device) {
    case Device::motor_left:
    case Device::motor_right:
      return "motor";
    case Device::imu_body:
    case Device::imu_foot:
      return "imu";
    case Device::computer:
      return cell.kind == Kind::restart ? "restart" : "computer";
    case Device::robot:
      return cell.kind == Kind::limit ? "limit" : "robot";
    default:
      return std::string(name_of(cell.device));
  }
}

}  // namespace sandhopper::faults
