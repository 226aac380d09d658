#include "tools/diagnose/plants/hopper/hopper_runs.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>

namespace sandhopper::diagnose {
namespace {

constexpr std::uint64_t kStay = 200;  // a run that was used again stays for this many more requests

bool acts_on_plant(const std::string& channel) {
  return channel == "actuator" || channel.ends_with("position_rad");
}

// Bitwise, so that a NaN equals itself.
bool same(const HopperRuns::Key& a, const HopperRuns::Key& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// Appends an edit to a key. False if its law has no key of its own.
bool append(const SensorEdit& edit, HopperRuns::Key& key) {
  key.push_back(static_cast<double>(edit.kind));
  key.push_back(edit.value);
  key.push_back(std::bit_cast<double>(edit.law_key));
  return edit.kind != SensorEdit::Kind::law || edit.law_key != 0;
}

}  // namespace

HopperRuns::Key HopperRuns::key(const Edits& edits, std::span<const double> plant_nuisances) {
  if (edits.laws_key == 0) return {};
  Key key{std::bit_cast<double>(edits.laws_key)};
  for (const auto& edit : edits.belief) {
    key.push_back(static_cast<double>(std::hash<std::string>{}(edit.key) >> 12));
    key.push_back(edit.factor);
    key.push_back(edit.addend);
  }
  for (const auto& edit : edits.sensors)
    if (acts_on_plant(edit.channel) && !append(edit, key)) return {};
  key.insert(key.end(), plant_nuisances.begin(), plant_nuisances.end());
  return key;
}

HopperRuns::Key HopperRuns::reading_key(const Edits& edits, std::string_view channel,
                                        std::span<const double> own_nuisances) {
  Key key{static_cast<double>(own_nuisances.size())};
  key.insert(key.end(), own_nuisances.begin(), own_nuisances.end());
  for (const auto& edit : edits.sensors)
    if (edit.channel == channel && !append(edit, key)) return {};
  return key;
}

bool HopperRuns::Run::Reading::copied(const Key& wanted, std::span<double> out) const {
  if (wanted.empty() || values.size() != out.size() || !same(key, wanted)) return false;
  std::ranges::copy(values, out.begin());
  return true;
}

HopperRuns::Run* HopperRuns::find(const Key& key, std::uint32_t block) {
  ++clock_;
  if (key.empty()) return nullptr;
  for (auto& run : runs_)
    if (run.block_ == block && same(run.key_, key)) {
      run.worth_ = clock_ + kStay;
      return &run;
    }
  return nullptr;
}

HopperRuns::Run& HopperRuns::keep(const Key& key, std::uint32_t block, HopperTraces traces) {
  Run& least = *std::ranges::min_element(runs_, {}, &Run::worth_);
  least.traces = std::move(traces);
  least.key_ = key;
  least.block_ = block;
  least.worth_ = clock_;
  for (auto& reading : least.readings_) reading.key.clear();
  return least;
}

}  // namespace sandhopper::diagnose
