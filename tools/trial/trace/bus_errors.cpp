#include "tools/trial/trace/bus_errors.hpp"

#include <fmt/format.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>

namespace sandhopper::trace {
namespace {

struct Kind {
  std::uint32_t bit;
  const char* name;
  bool loses_frames;
};

// Error classes: bits of the identifier.
constexpr std::array kClasses{
    Kind{CAN_ERR_TX_TIMEOUT, "transmit timeout", true}, Kind{CAN_ERR_LOSTARB, "lost arbitration", false},
    Kind{CAN_ERR_PROT, "protocol violation", false},    Kind{CAN_ERR_TRX, "transceiver", true},
    Kind{CAN_ERR_ACK, "no acknowledge", false},         Kind{CAN_ERR_BUSOFF, "bus-off", true},
    Kind{CAN_ERR_BUSERROR, "bus error", false},         Kind{CAN_ERR_RESTARTED, "restarted", true}};

// Controller states: bits of data[1] in a frame of class CAN_ERR_CRTL.
constexpr std::array kControllerStates{Kind{CAN_ERR_CRTL_RX_OVERFLOW, "receive overflow", true},
                                       Kind{CAN_ERR_CRTL_TX_OVERFLOW, "transmit overflow", true},
                                       Kind{CAN_ERR_CRTL_RX_WARNING, "error-warning", false},
                                       Kind{CAN_ERR_CRTL_TX_WARNING, "error-warning", false},
                                       Kind{CAN_ERR_CRTL_RX_PASSIVE, "error-passive", true},
                                       Kind{CAN_ERR_CRTL_TX_PASSIVE, "error-passive", true},
                                       Kind{CAN_ERR_CRTL_ACTIVE, "error-active again", false}};

template <std::size_t Count>
bool take(const std::array<Kind, Count>& kinds, std::uint32_t bits, BusErrors& errors) {
  bool any = false;
  const char* counted = "";  // receive and transmit side have the same name; count it once
  for (const auto& kind : kinds) {
    if ((bits & kind.bit) == 0) continue;
    any = true;
    errors.frames_lost |= kind.loses_frames;
    if (std::string_view(counted) != kind.name) ++errors.kinds[kind.name];
    counted = kind.name;
  }
  return any;
}

}  // namespace

BusErrors count_bus_errors(const std::vector<Frame>& frames) {
  BusErrors errors;
  for (const auto& frame : frames) {
    if (!frame.is_error()) continue;
    ++errors.frames;
    errors.bus_off |= (frame.id & CAN_ERR_BUSOFF) != 0;
    bool named = take(kClasses, frame.id, errors);
    if ((frame.id & CAN_ERR_CRTL) != 0) named |= take(kControllerStates, frame.data[1], errors);
    if (!named) ++errors.kinds["not specified"];
    if ((frame.id & CAN_ERR_CRTL) != 0 || (frame.id & CAN_ERR_CNT) != 0) {
      errors.transmit_errors = std::max<int>(errors.transmit_errors, frame.data[6]);
      errors.receive_errors = std::max<int>(errors.receive_errors, frame.data[7]);
    }
  }
  return errors;
}

Findings bus_error_findings(const BusErrors& errors) {
  if (errors.frames == 0) return {};
  std::string text = fmt::format("{} error frames:", errors.frames);
  for (const auto& [kind, count] : errors.kinds) text += fmt::format(" {} {},", count, kind);
  text.pop_back();
  if (errors.transmit_errors + errors.receive_errors > 0)
    text += fmt::format("; error counters up to {} sending, {} receiving", errors.transmit_errors,
                        errors.receive_errors);
  return {{errors.bus_off ? "bus_off" : "error_frames", text,
           errors.bus_off
               ? "the controller took no part in the bus from then on: check termination, bit rate "
                 "and wiring, then record again"
               : "check termination, bit rate and wiring",
           !errors.frames_lost}};
}

}  // namespace sandhopper::trace
