#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

// Input of the scorer: the answers of `hop conceal` and the diagnosis.json files of `hop diagnose`.
namespace sandhopper::benchmark {

// A part of the recordings: one channel in one phase of the motion.
struct Cell {
  std::string channel, phase;
  auto operator<=>(const Cell&) const = default;
};

// An answer of `hop conceal`: the hidden effects.
struct Truth {
  std::string name;  // name of the campaign, "001"
  std::string plant, kind;
  struct Effect {
    std::string id;
    double size;  // relative to typical
    std::map<std::string, double> parameters;
    // Cells in which it exceeds the noise; nullopt if the answer does not state them.
    std::optional<std::set<Cell>> cells{};
    std::string channel{};  // of a sensor's effect
  };
  std::vector<Effect> effects;
  std::optional<std::string> unknown_port;
  std::vector<std::string> alike;  // Effects that the data cannot distinguish, the hidden one first.
  double visibility = 0.0;

  bool nothing_hidden() const { return effects.empty(); }
  bool holds(const std::string& id) const;
  // The cells of all hidden effects; empty if the answer does not state those of every one.
  std::set<Cell> cells() const;
};

// One entry of `effects` in diagnosis.json.
struct Claim {
  std::string id;
  double probability = 0.0;
  std::vector<std::string> alike;  // indistinguishable_from
  struct Value {
    double value = 0.0, low = 0.0, high = 0.0;
    bool has_interval = false;
  };
  std::map<std::string, Value> parameters;

  // True if the claim names the effect, itself or in its class.
  bool covers(const std::string& id) const;
};

// An effect that was not found, and the 95 % bound of its size (`absent`).
struct UpperBound {
  std::string id, parameter;  // id with the channel of a sensor's effect: "clock.skew[force_N]"
  double value = 0.0;
  bool is_lower = false;  // of a stiffness or a limit, which falls as the effect grows

  // The hidden size that it bounds; nullopt if it is of another effect or channel, or has no counterpart.
  std::optional<double> size_of(const Truth::Effect& effect) const;
  bool holds(double size) const { return is_lower ? size >= value : size <= value; }
};

// A diagnosis.json as read; claims sorted by probability, most probable first.
struct Diagnosis {
  std::string verdict, detail;
  std::vector<Claim> claims;
  std::vector<UpperBound> absent;
  std::set<Cell> where;
  std::optional<double> heldout_after, floor;
  std::optional<double> seconds;
  bool asks_for_a_split = false;                 // Recommends a trial to separate the members of a class.
  std::map<std::string, std::string> baselines;  // Answers of simple methods, if the tool writes them.
  bool says_missing() const { return verdict == "missing_physics" || verdict == "unknown_physics"; }
};

// Reads all NNN.json of a folder, sorted by name. Throws std::runtime_error with the file that cannot be
// read.
std::vector<Truth> read_truths(const std::filesystem::path& folder);
// nullopt if the tool gave no answer (no file, an empty one, or invalid JSON).
std::optional<Diagnosis> read_diagnosis(const std::filesystem::path& file);

}  // namespace sandhopper::benchmark
