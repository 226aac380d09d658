#pragma once
#include <cstdint>
#include <string>

#include "config/fields.hpp"

namespace sandhopper {

enum class Bias : std::uint8_t { as_is, none, pull_up, pull_down };
template <>
struct EnumNames<Bias> {
  static constexpr std::array<std::string_view, 4> value{"as_is", "none", "pull_up", "pull_down"};
};

// One GPIO line. `chip`: label, name or path of the chip (gpiodetect lists them); empty: any chip that has a
// line of that name. `line`: the line's name or its number on the chip; empty: not fitted.
struct LineConfig {
  std::string chip;
  std::string line;
  bool active_low = false;
  Bias bias = Bias::as_is;

  bool fitted() const noexcept { return !line.empty(); }

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("chip", self.chip);
    visit("line", self.line);
    visit("active_low", self.active_low);
    visit("bias", self.bias);
  }
};

}  // namespace sandhopper
