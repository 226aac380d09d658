#pragma once
#include <cstddef>
#include <span>
#include <vector>

// Likelihood-ratio tests of y ~ N(0, r S) against y ~ N(A h, r S) for given shapes h and unknown A and r >=
// 1. S is the sum of a covariance of the observations and of terms with a normal prior. Plain loops in a
// fixed order: equal observations give equal bits on every processor.
namespace sandhopper {

class NormalTest {
 public:
  // `terms`: number of further parameters, which reduces the degrees of freedom.
  NormalTest(std::size_t observations, int terms)
      : n_(observations), terms_(terms), value_(observations), covariance_(observations * observations) {}

  void observe(std::size_t i, double value) { value_[i] = value; }

  // Call add_covariance and add_term before the first test.
  template <class Covariance>
  void add_covariance(const Covariance& covariance) {
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j <= i; ++j) add(i, j, covariance(i, j));
  }
  template <class Value>
  void add_term(double standard_deviation, const Value& value) {
    std::vector<double> x(n_);
    for (std::size_t i = 0; i < n_; ++i) x[i] = standard_deviation * value(i);
    add_covariance([&](std::size_t i, std::size_t j) { return x[i] * x[j]; });
  }

  struct Result {
    double size = 0.0;     // A
    double size_sd = 0.0;  // standard deviation of A, including r
    double statistic = 0.0;
  };
  Result test(std::span<const double> shape) const;

 private:
  void add(std::size_t i, std::size_t j, double value) {
    covariance_[i * n_ + j] += value;
    if (i != j) covariance_[j * n_ + i] += value;
    inverse_.clear();
  }
  void invert() const;

  std::size_t n_;
  int terms_;
  std::vector<double> value_;
  std::vector<double> covariance_;
  mutable std::vector<double> inverse_;   // empty until the first test
  mutable std::vector<double> weighted_;  // S^-1 y
  mutable double distance_ = 0.0;         // y' S^-1 y
};

}  // namespace sandhopper
