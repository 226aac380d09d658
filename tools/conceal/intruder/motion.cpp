#include <algorithm>
#include <cmath>

#include "tools/conceal/intruder/world.hpp"

namespace sandhopper::conceal::intruder {
namespace {

constexpr double kStep_s = 2.5e-4;
constexpr double kStart_m = -0.02;  // Start of the motion: above the surface (depth is positive).

// Builds a motion from pieces. Speed changes follow a raised cosine.
class Writer {
 public:
  Writer() {
    for (auto* trace : {&motion_.depth_m, &motion_.speed_mps, &motion_.acceleration_mps2})
      trace->step_s = kStep_s;
  }
  void change_speed(double to_mps, double duration_s) {
    const double from = speed_, steps = std::max(2.0, std::round(duration_s / kStep_s));
    for (double i = 1.0; i <= steps; ++i)
      put(from + (to_mps - from) * 0.5 * (1.0 - std::cos(3.14159265358979 * i / steps)));
  }
  void run_to(double depth_m) {
    while ((speed_ > 0.0) == (depth_ < depth_m)) put(speed_);
  }
  void stay(double duration_s) {
    for (double t = 0.0; t < duration_s; t += kStep_s) put(speed_);
  }
  double depth_m() const { return depth_; }
  Motion take() { return std::move(motion_); }

 private:
  void put(double speed_mps) {
    const double acceleration = (speed_mps - speed_) / kStep_s;
    depth_ += 0.5 * (speed_ + speed_mps) * kStep_s;
    speed_ = speed_mps;
    motion_.depth_m.values.push_back(depth_);
    motion_.speed_mps.values.push_back(speed_);
    motion_.acceleration_mps2.values.push_back(acceleration);
  }

  Motion motion_;
  double depth_ = kStart_m;
  double speed_ = 0.0;
};

}  // namespace

Motion prescribed(const World&, const Setup& setup) {
  const double speed = setup.number("impact_speed_mps", 0.2), depth = setup.number("depth_m", 0.04);
  const auto profile = setup.text("profile", "stop_and_withdraw");
  const double ramp_s = std::min(0.05, 0.016 / speed);  // 8 mm to accelerate and 8 mm to stop
  const double stop_m = 0.5 * speed * ramp_s;
  Writer writer;
  writer.stay(0.05);
  if (profile == "cycles") {
    for (int i = 1; i <= 3; ++i) {
      writer.change_speed(speed, ramp_s);
      writer.run_to(depth * (0.4 + 0.2 * i) - stop_m);
      writer.change_speed(0.0, ramp_s);
      writer.change_speed(-0.1, 0.02);
      writer.run_to(-0.01);
      writer.change_speed(0.0, 0.02);
    }
    return writer.take();
  }
  writer.change_speed(speed, ramp_s);
  writer.run_to(depth - stop_m);
  if (profile == "through") return writer.take();  // The recording ends at full speed.
  writer.change_speed(0.0, ramp_s);
  writer.stay(0.08);
  writer.change_speed(-0.1, 0.02);
  writer.run_to(-0.01);
  return writer.take();
}

}  // namespace sandhopper::conceal::intruder
