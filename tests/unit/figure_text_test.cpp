#include "tools/terrain/figure_text.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sandhopper {
namespace {

TEST(FigureText, AFigureWithoutAnIntervalHasFourDigits) {
  EXPECT_EQ(figure_number(913898.2), "913900");
  EXPECT_EQ(figure_number(1050831.0), "1051000");
  EXPECT_EQ(figure_number(4075.3), "4075");
  EXPECT_EQ(figure_number(-14.2234), "-14.22");
  EXPECT_EQ(figure_number(std::nan("")), "–");
}

// An intercept at its bound was printed as "-2.274e-13 mm".
TEST(FigureText, TheRoundingOfASumIsZero) {
  EXPECT_EQ(figure_number(-2.274e-13), "0");
  EXPECT_EQ(figure_number(2.5e-6), "2.5e-06");
}

TEST(FigureText, UnitsHavePowers) {
  EXPECT_EQ(figure_unit("greatest_resistance_mps2"), "m/s²");
  EXPECT_EQ(figure_unit("stiffness_N_per_m"), "N/m");
}

}  // namespace
}  // namespace sandhopper
