#pragma once
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/consistency.hpp"

namespace sandhopper {

struct NamedValue {
  std::string key;
  double value;
};

// Collects contradictions, each with its calculation.
class ContradictionList {
 public:
  // `by` requires `needed`. `key`, whose value is shown as `written`, provides only `carried`.
  struct Carry {
    std::string key;
    std::string written;
    double carried;
    NamedValue by;
    double needed;
    std::string_view unit;
    std::string cure;
  };
  // Adds a contradiction if carried < needed or carried is NaN.
  void carries(const Carry& c) {
    if (c.carried >= c.needed) return;
    found_.push_back({c.key, fmt::format("{} carries {:.4g} {}, {} = {:g} asks for {:.4g}: {}", c.written,
                                         c.carried, c.unit, c.by.key, c.by.value, c.needed, c.cure)});
  }

  // Adds a contradiction unless low < high.
  void below(const NamedValue& low, const NamedValue& high, std::string_view because) {
    if (low.value < high.value) return;
    found_.push_back({low.key, fmt::format("{:g} must be less than {} = {:g}: {}", low.value, high.key,
                                           high.value, because)});
  }

  void add_if(bool wrong, const std::string& key, const std::string& text) {
    if (wrong) found_.push_back({key, text});
  }

  std::vector<Contradiction> take() { return std::move(found_); }

 private:
  std::vector<Contradiction> found_;
};

}  // namespace sandhopper
