#pragma once
#include <array>
#include <string_view>

#include "tools/experiment/treatments.hpp"

namespace sandhopper::paper {

// Mean abs(k_est/k_GT - 1) of an independent simulation with the same definitions (8 seeds of 75 hops), and
// the tolerance for another implementation. For comparison only: nothing is computed from these values.
struct ReferenceCase {
  std::string_view name;
  std::array<double, kTreatments> error;
  std::array<double, kTreatments> band;
};

inline constexpr std::array<ReferenceCase, 8> kReferenceCases{{
    {"A", {0.147, 0.070, 0.056}, {0.015, 0.010, 0.012}},
    {"A2", {0.145, 0.067, 0.042}, {0.020, 0.020, 0.020}},
    {"B", {0.129, 0.020, 0.126}, {0.015, 0.015, 0.015}},
    {"C", {0.207, 0.028, 0.031}, {0.030, 0.030, 0.030}},
    {"C2", {0.178, 0.041, 0.059}, {0.020, 0.020, 0.020}},
    {"D", {0.65, 0.65, 0.89}, {0.020, 0.020, 0.020}},
    {"E", {0.33, 0.13, 0.28}, {0.020, 0.020, 0.020}},
    {"T", {0.120, 0.078, 0.056}, {0.020, 0.020, 0.020}},
}};

}  // namespace sandhopper::paper
