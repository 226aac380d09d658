#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

// The scorer's input: the sealed answers of `hop conceal` and diagnosis.json of `hop diagnose`.
namespace sandhopper::benchmark {

struct Truth {
  std::string name;  // of the campaign, "001"
  std::string plant, kind;
  struct Effect {
    std::string id;
    double size;  // relative to typical
    std::map<std::string, double> parameters;
  };
  std::vector<Effect> effects;
  std::optional<std::string> unknown_port;
  std::vector<std::string> alike;  // ids the data cannot tell apart, the true one first
  double visibility = 0.0;

  bool nothing_hidden() const { return effects.empty(); }
  bool holds(const std::string& id) const;
};

struct Claim {
  std::string id;
  double probability = 0.0;
  std::vector<std::string> alike;  // indistinguishable_from
  struct Value {
    double value = 0.0, low = 0.0, high = 0.0;
    bool has_interval = false;
  };
  std::map<std::string, Value> parameters;

  // Whether it names the effect, by itself or through its class.
  bool covers(const std::string& id) const;
};

// An effect that was not found, and the size it stays below with 95 % (`absent`).
struct UpperBound {
  std::string id, parameter;
  double value = 0.0;
};

struct Diagnosis {
  std::string verdict, detail;
  std::vector<Claim> claims;
  std::vector<UpperBound> absent;
  std::optional<double> heldout_after, floor;
  std::optional<double> seconds;
  bool asks_for_a_split = false;  // recommends a trial to tell a class' members apart
  std::map<std::string, std::string>
      baselines;  // what plainer methods would have named, where the tool tells
  bool says_missing() const { return verdict == "missing_physics" || verdict == "unknown_physics"; }
};

// All NNN.json of a folder, by name. Throws std::runtime_error naming the file that cannot be read.
std::vector<Truth> read_truths(const std::filesystem::path& folder);
// nullopt where the tool gave no answer (no file, or an empty one).
std::optional<Diagnosis> read_diagnosis(const std::filesystem::path& file);

}  // namespace sandhopper::benchmark
