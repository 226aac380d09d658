#include "tools/diagnose/model/edits.hpp"

// Not inline, because every effect includes edits.hpp.
namespace sandhopper::diagnose {

void Edits::scale(std::string key, double factor) { belief.push_back({std::move(key), factor, 0.0}); }
void Edits::add(std::string key, double addend) { belief.push_back({std::move(key), 1.0, addend}); }

void Edits::sensor(std::string channel, SensorEdit::Kind kind, double value, double window_s) {
  sensors.push_back({std::move(channel), kind, value, window_s, {}, 0});
}

void Edits::add_sensor_law(std::string channel, Law law) {
  sensors.push_back({std::move(channel), SensorEdit::Kind::law, 0.0, 0.0, std::move(law), 0});
}

}  // namespace sandhopper::diagnose
