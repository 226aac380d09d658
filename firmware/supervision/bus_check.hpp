#pragma once
#include <array>

#include "drivers/samples.hpp"
#include "firmware/supervision/counts.hpp"
#include "firmware/supervision/findings.hpp"

namespace sandhopper {

// Checks the motors' bus: the controller's state, and all error counts, which must not increase.
class BusCheck {
 public:
  void see(const BusSample& bus, Findings& findings) noexcept {
    if (!started_) last_ = bus;
    started_ = true;
    const auto grown = [](std::uint32_t now, std::uint32_t before) {
      return static_cast<double>(now - before);
    };
    // Tested without a difference, so that a frame refused before the first cycle counts, too.
    findings.add_if(bus.refused.count > 0, Fault::transmit_refused, static_cast<double>(bus.refused.rule),
                    bus.refused.can_id);
    findings.add_if(bus.state == BusState::off, Fault::bus_off, 1.0, 0.0);
    const double unheard = grown(bus.no_acknowledge, last_.no_acknowledge);
    findings.add_if(bus.state == BusState::passive || unheard > 0.0, Fault::bus_passive, unheard, 0.0);
    for (std::size_t i = 0; i < kMotorCount; ++i) {
      const double rejected = grown(bus.rejected[i], last_.rejected[i]);
      findings.add_if(rejected > 0.0, Fault::motor_reply_foreign, static_cast<double>(i), rejected);
      const bool unexpected = bus.unsolicited[i] != last_.unsolicited[i];
      findings.add_if(unexpected_[i].see(unexpected) >= kUnexpected, Fault::motor_reply_unexpected,
                      static_cast<double>(i), unexpected_[i].value());
    }
    const double refused = grown(bus.send_failures, last_.send_failures);
    findings.add_if(refused > 0.0, Fault::bus_send_refused, refused, 0.0);
    const double dropped = grown(bus.receive_overflows, last_.receive_overflows);
    findings.add_if(dropped > 0.0, Fault::bus_overflow, dropped, 0.0);
    const double errors = grown(bus.errors, last_.errors);
    findings.add_if(errors > 0.0, Fault::bus_fault, errors, 0.0);
    last_ = bus;
  }

 private:
  // One surplus answer can be a reply that was read late. Five within a few cycles mean a second drive.
  static constexpr double kUnexpected = 5.0;
  BusSample last_{};
  std::array<LeakyCount, kMotorCount> unexpected_{LeakyCount{0.25}, LeakyCount{0.25}};
  bool started_ = false;
};

}  // namespace sandhopper
