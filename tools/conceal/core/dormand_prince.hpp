#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace sandhopper::conceal {

// Explicit Runge-Kutta method of order 5(4) by Dormand and Prince (J. Comp. Appl. Math. 6, 1980) with step
// control. Stops at the first zero of a guard function.
//
//   rhs(t_s, x) -> dx/dt          guard(t_s, x) -> positive while the present equations hold
template <std::size_t N>
class DormandPrince {
 public:
  using State = std::array<double, N>;

  struct Tolerance {
    double relative = 1e-7;
    double absolute = 1e-9;
    double least_step_s = 1e-7;
  };

  explicit DormandPrince(Tolerance tolerance = {}) : tolerance_(tolerance) {}

  // Advances x from t_s towards end_s. Returns true if the guard became negative before; then t_s and x are
  // those of that time.
  template <class Rhs, class Guard>
  bool advance(double& t_s, State& x, double end_s, const Rhs& rhs, const Guard& guard) {
    double before = guard(t_s, x);
    while (t_s < end_s - 1e-12) {
      const double h = std::min(step_s_, end_s - t_s);
      State y;
      const double error = try_step(t_s, x, h, rhs, y);
      const bool smallest = h <= tolerance_.least_step_s;
      if (!(error <= 1.0) && !smallest) {
        step_s_ = h * std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.1, 0.9);
        continue;
      }
      const double after = guard(t_s + h, y);
      if (after < 0.0) {
        if (before > 0.0)
          locate(t_s, x, h, rhs, guard, y);
        else
          t_s += h, x = y;
        return true;
      }
      t_s += h;
      x = y;
      before = after;
      if (h >= step_s_ || error > 0.5)
        step_s_ = std::clamp(h * std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 4.0),
                             tolerance_.least_step_s, 5e-3);
    }
    return false;
  }

 private:
  template <class Rhs>
  double try_step(double t, const State& x, double h, const Rhs& rhs, State& y) const {
    const State k1 = rhs(t, x);
    const State k2 = rhs(t + h / 5, add(x, h, {1.0 / 5}, k1));
    const State k3 = rhs(t + h * 3 / 10, add(x, h, {3.0 / 40, 9.0 / 40}, k1, k2));
    const State k4 = rhs(t + h * 4 / 5, add(x, h, {44.0 / 45, -56.0 / 15, 32.0 / 9}, k1, k2, k3));
    const State k5 =
        rhs(t + h * 8 / 9,
            add(x, h, {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729}, k1, k2, k3, k4));
    const State k6 =
        rhs(t + h, add(x, h, {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656}, k1,
                       k2, k3, k4, k5));
    y = add(x, h, {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}, k1, k2, k3, k4, k5,
            k6);
    const State k7 = rhs(t + h, y);
    double worst = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      const double e = h * (71.0 / 57600 * k1[i] - 71.0 / 16695 * k3[i] + 71.0 / 1920 * k4[i] -
                            17253.0 / 339200 * k5[i] + 22.0 / 525 * k6[i] - 1.0 / 40 * k7[i]);
      const double scale =
          tolerance_.absolute + tolerance_.relative * std::max(std::abs(x[i]), std::abs(y[i]));
      worst = std::max(worst, std::abs(e) / scale);
    }
    return std::isfinite(worst) ? worst : 1e10;
  }

  template <std::size_t K, class... Slopes>
  static State add(const State& x, double h, const double (&weights)[K], const Slopes&... slopes) {
    static_assert(K == sizeof...(Slopes));
    State y = x;
    std::size_t k = 0;
    const auto one = [&](const State& slope) {
      const double w = h * weights[k++];
      for (std::size_t i = 0; i < N; ++i) y[i] += w * slope[i];
    };
    (one(slopes), ...);
    return y;
  }

  // The guard changes its sign within the step: shorten the step by bisection until it ends just after the
  // zero.
  template <class Rhs, class Guard>
  void locate(double& t, State& x, double h, const Rhs& rhs, const Guard& guard, const State& at_end) const {
    double low = 0.0, high = h;
    State y = at_end;
    while (high - low > 1e-8) {
      const double middle = 0.5 * (low + high);
      State trial;
      try_step(t, x, middle, rhs, trial);
      if (guard(t + middle, trial) < 0.0)
        high = middle, y = trial;
      else
        low = middle;
    }
    t += high;
    x = y;
  }

  Tolerance tolerance_;
  double step_s_ = 1e-4;
};

}  // namespace sandhopper::conceal
