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

// A bound of 8500 N/m was printed as "8.5e+03".
TEST(DiagnoseDigits, NoExponentWhereZerosNeedNoCounting) {
  EXPECT_EQ(plain_number(8542.0, 2), "8500");
  EXPECT_EQ(plain_number(-1467.0, 2), "-1500");
  EXPECT_EQ(plain_number(0.00123, 2), "0.0012");
  EXPECT_EQ(plain_number(96.0, 2), "96");
  EXPECT_EQ(plain_number(0.0, 2), "0");
  EXPECT_EQ(plain_number(2.3e-5, 2), "2.3e-05");
  EXPECT_EQ(plain_number(2.34e7, 2), "2.3e+07");
  EXPECT_EQ(number(12345.0), "12340");
  EXPECT_EQ(number(0.25), "0.25");
}

TEST(DiagnoseDigits, AProbabilityIsNoSmallerThanTailsAreKnown) {
  EXPECT_EQ(probability_text(0.0025), "0.0025");
  EXPECT_EQ(probability_text(7.2e-11), "<\u00a00.0001");
}

}  // namespace
}  // namespace sandhopper::diagnose
