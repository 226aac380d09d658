#include "tools/diagnose/model/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tools/report/digits.hpp"

namespace sandhopper::diagnose {
namespace {

// Longer suffixes first, because "_N" also ends "_m_per_N".
constexpr std::array<std::pair<const char*, const char*>, 28> kUnits{{{"_rad_per_Nm", "rad/(N m)"},
                                                                      {"_N_s2_per_m2", "N s²/m²"},
                                                                      {"_kg_per_m3", "kg/m³"},
                                                                      {"_N_s_per_m", "N s/m"},
                                                                      {"_N_per_m3", "N/m³"},
                                                                      {"_Nm_per_A", "N m/A"},
                                                                      {"_N_per_m", "N/m"},
                                                                      {"_m_per_N", "m/N"},
                                                                      {"_Nm_s2", "N m s²"},
                                                                      {"_kg_m2", "kg m²"},
                                                                      {"_radps", "rad/s"},
                                                                      {"_Nm_s", "N m s"},
                                                                      {"_mps2", "m/s²"},
                                                                      {"_mps", "m/s"},
                                                                      {"_rad", "rad"},
                                                                      {"_Nm", "N m"},
                                                                      {"_kg", "kg"},
                                                                      {"_m2", "m²"},
                                                                      {"_m3", "m³"},
                                                                      {"_Hz", "Hz"},
                                                                      {"_Pa", "Pa"},
                                                                      {"_N", "N"},
                                                                      {"_A", "A"},
                                                                      {"_C", "°C"},
                                                                      {"_V", "V"},
                                                                      {"_m", "m"},
                                                                      {"_s", "s"},
                                                                      {"_J", "J"}}};

// Names of keys that are not the words for them.
constexpr std::array<std::pair<const char*, const char*>, 5> kWords{
    {{"t", "time"},
     {"accel", "acceleration"},
     {"accel bias", "acceleration bias"},
     {"bed stiffness relative", "bed stiffness, share"},
     {"while it bears", "share while the bed still bears"}}};

// The head of an order: takes the words and values that it names out of a set-up.
class Order {
 public:
  Order(std::map<std::string, std::string>& words, std::map<std::string, double>& setup)
      : words_(words), setup_(setup) {}

  std::string of(const std::string& kind) {
    if (kind == "drop") return drop();
    if (kind == "hop")
      return "Let the robot hop" + taken(" from {}", "release_height_m") +
             taken(" with a leg stiffness of {}", "compression_stiffness_N_per_m");
    if (kind == "intrusion") return intrusion();
    if (kind == "motion") return motion();
    if (kind == "hold")
      return setup_.contains("position_rad")
                 ? "Hold the axis" + taken(" at {}", "position_rad") + taken(" for {}", "duration_s")
                 : "Hold everything still";
    if (kind == "press") return "Press the foot in slowly";
    if (kind == "air_sweep") return "Sweep the foot in the air with the body clamped";
    if (kind == "tap") return "Tap the foot";
    return "Record a trial of the kind " + in_words(kind);
  }

 private:
  // `text` with the value of a key in place of {}; empty if the set-up lacks the key.
  std::string taken(std::string text, const std::string& key) {
    const auto found = setup_.find(key);
    if (found == setup_.end()) return "";
    text.replace(text.find("{}"), 2, measured(found->second, quantity_of(key).unit));
    setup_.erase(found);
    return text;
  }

  std::string profile() {
    const auto found = words_.find("profile");
    return found == words_.end() ? "" : found->second;
  }

  std::string drop() {
    const auto speed = setup_.find("release_speed_mps");
    const bool is_thrown = speed != setup_.end() && speed->second > 0.0;
    if (speed != setup_.end() && !is_thrown) setup_.erase(speed);
    const auto height = taken(" from {}", "release_height_m");
    if (!is_thrown) return "Drop the body" + (height.empty() ? " once more" : height);
    return "Throw the body down" + height + taken(" at {}", "release_speed_mps");
  }

  std::string intrusion() {
    const auto how = profile();
    const auto plate = "the plate" + taken(" of {} diameter", "plate_diameter_m");
    const auto depth = taken(" to {}", "depth_m"), speed = taken(" at {}", "impact_speed_mps");
    if (how == "cycles" || how == "stop_and_withdraw" || how == "through") words_.erase("profile");
    if (how == "cycles") return "Push " + plate + " in and pull it out in cycles" + depth + speed;
    if (how == "stop_and_withdraw") return "Push " + plate + " in" + depth + speed + ", stop and pull it out";
    return "Push " + plate + " in" + depth + speed + (how == "through" ? " without a stop" : "");
  }

  std::string motion() {
    const auto how = profile();
    if (how == "release" || how == "sine" || how == "chirp" || how == "ramp") words_.erase("profile");
    if (how == "release")
      return "Let the axis go" + taken(" from {}", "release_position_rad") +
             taken(" and record it for {}", "duration_s");
    if (how == "sine")
      return "Drive the axis along a sine" + taken(" of {}", "amplitude_rad") +
             taken(" at {}", "frequency_Hz") + taken(" for {}", "duration_s");
    if (how == "chirp")
      return "Drive the axis along a sine" + taken(" of {}", "amplitude_rad") + " that speeds up" +
             taken(" from {}", "frequency_Hz") + taken(" to {}", "end_frequency_Hz") +
             taken(" within {}", "duration_s");
    if (how == "ramp")
      return "Drive the axis to and fro" + taken(" by {} to each side", "amplitude_rad") +
             taken(" at a steady {}", "speed_radps") + taken(" for {}", "duration_s");
    return "Drive the axis" + taken(" for {}", "duration_s");
  }

  std::map<std::string, std::string>& words_;
  std::map<std::string, double>& setup_;
};

}  // namespace

Quantity quantity_of(const std::string& key) {
  if (const auto comma = key.find(", "); comma != std::string::npos) {  // "depth_m, unloading"
    Quantity first = quantity_of(key.substr(0, comma));
    first.words += key.substr(comma);
    return first;
  }
  Quantity q{key, ""};
  for (const auto& [suffix, unit] : kUnits)
    if (key.ends_with(suffix)) {
      q = {key.substr(0, key.size() - std::char_traits<char>::length(suffix)), unit};
      break;
    }
  q.words = in_words(q.words);
  for (const auto& [key_words, words] : kWords)
    if (q.words == key_words) q.words = words;
  return q;
}

std::string in_words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string measured(double value, const std::string& unit) {
  if (unit == "m" && value != 0.0 && std::abs(value) < kShort_m) return measured(1e3 * value, "mm");
  std::string text = std::abs(value) >= 1000.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
  return unit.empty() ? text : text + " " + unit;
}

std::string trial_in_words(const std::string& kind, std::map<std::string, std::string> words,
                           std::map<std::string, double> setup, Telling telling) {
  setup.erase("session");
  std::string text = kind;
  if (telling == Telling::order) text = Order(words, setup).of(kind);
  for (const auto& [key, word] : words) text += ", " + in_words(word);
  for (const auto& [key, value] : setup) {
    const auto q = quantity_of(key);
    const auto size = telling == Telling::order ? measured(value, q.unit)
                                                : number(value) + (q.unit.empty() ? "" : " " + q.unit);
    text += fmt::format(", {} {}", q.words, size);
  }
  return text;
}

std::string number(double value) {
  const double magnitude = std::abs(value);
  return plain_number(value, magnitude > 0.0 && (magnitude < 1e-3 || magnitude >= 1e5) ? 3 : 4);
}

std::string with_interval(double value, double low, double high, const std::string& unit) {
  const double half = 0.5 * std::abs(high - low);
  const std::string after = unit.empty() ? "" : " " + unit;
  if (!(half > 0.0) || !std::isfinite(half)) return number(value) + after;
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(half)));
  if (decimals > 6 || decimals < 0) {
    const auto text = [half](double number_in) {
      return digits_by(number_in, half).value_or(number(number_in));
    };
    return fmt::format("{}{} (95 %: {} to {})", text(value), after, text(low), text(high));
  }
  return fmt::format("{:.{}f}{} (95 %: {:.{}f} to {:.{}f})", value, decimals, after, low, decimals, high,
                     decimals);
}

}  // namespace sandhopper::diagnose
