#include <gtest/gtest.h>

#include <cmath>

#include "tools/diagnose/model/digits.hpp"

namespace sandhopper::diagnose {
namespace {

TEST(DiagnoseDigits, AValueHasTwoDigitsOfItsUncertainty) {
  EXPECT_EQ(to_digits_of(0.1688, 0.125), "0.17");
  EXPECT_EQ(to_digits_of(2.458, 0.236), "2.46");
  EXPECT_EQ(to_digits_of(-3.38e-6, 0.0084), "0");
  EXPECT_EQ(to_digits_of(-7.27e-6, 6.6e-6), "-7.3e-06");
  EXPECT_EQ(to_digits_of(12345.678, 130.0), "12350");
  EXPECT_EQ(to_digits_of(150.0, 130.0), "150");
  EXPECT_EQ(to_digits_of(0.0, 130.0), "0");
}

TEST(DiagnoseDigits, WithoutAnUncertaintyTheValueKeepsItsDigits) {
  EXPECT_EQ(to_digits_of(0.1688, 0.0), "0.1688");
  EXPECT_EQ(to_digits_of(0.5, 1e-17), "0.5");
  EXPECT_EQ(to_digits_of(0.1688, INFINITY), "0.1688");
}

}  // namespace
}  // namespace sandhopper::diagnose
