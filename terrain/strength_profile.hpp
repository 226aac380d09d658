#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "terrain/profile_sums.hpp"
#include "terrain/small_gaussian.hpp"

// Quasi-static force of the ground over depth, F(z), from the strides of one trial, with a pointwise 95 %
// band. The curve starts at zero. It is the believed bed's own curve m(z) plus a part that is linear in cells
// of 2.5 mm:
//   F(z) = m(z) + k b (1 - exp(-z/dz0)) + integral of kappa,   b the intercept depth beyond the believed one,
//   kappa_j the tangent stiffness of cell j beyond the believed one
//   kappa ~ N(0, Sigma),  Sigma_ij = s_i s_j exp(-|i - j| h / L),  s_j = s * believed tangent stiffness
//   force = F(z + D) + c A + lambda rho A_f v^2 + e Q + f tanh(Ldot / v_s) + noise,
//   D = d + x(t) - x(0) + l (v - v_0)
// with A and f as in joint_fit.hpp, A_f the foot's area, Q the force from the motors' current, e the relative
// error of the torque constant, d the depth at which the contact is detected, x the error of the Kalman
// filter's height, t the time since contact, l a lag between force and depth, and v_0 the speed at contact.
// Contact is detected when the force behind the accelerometer's low-pass (time constant tau) exceeds a
// threshold T. A slow foot on soft ground is then already deep, and on ground without inertia a fast foot is,
// too. With the gain g = 1 - exp(-t / tau) and the blow B = (c m_a'(0) + lambda rho A_f) v_0^2
//   d = v_0 (t + t_c),   B g + F(v_0 (t - tau g)) = T,   var(d) = var(v_0 t) + (s_t v_0)^2 + s_d^2
// where t has the noise of T, s_t is that of the cycle and s_d that of the surface. c and lambda are known
// roughly, and d is far from linear in them. So mean and variance of v_0 t are taken over their posterior, in
// which c = lambda = 0 has a prior probability of its own (profile_contact.cpp). d depends on the curve that
// is sought, so its change with the slope of the first cells is a part of the columns of the fit. t_c is the
// mean time from there to the motors' reply whose depth is taken. The filter fuses an accelerometer whose
// noise is white with a white height, so its error is stationary, and from the filter's Riccati equation
// follows
//   cov(x(t), x(t')) = s_x^2 exp(-a |t - t'|) cos(a (t - t')),  a = (q / 4 r)^(1/4)
// q and r are the spectral densities of the noise of acceleration and height. (Gain K = (2 a, 2 a^2), so the
// error decays and turns with a, and (exp((A - K C) t) P)_11 = P_11 exp(-a t) cos(a t).) So D grows like a
// random walk at first and is bounded later. A cell has one D, that at the mean time of its samples.
// The smoothness length L and the spread s are integrated over a grid by their marginal likelihood, so the
// band includes their uncertainty (Rasmussen & Williams 2006, section 5.2).
// No sample of a stride shows the depth error D: a curve that is shifted or stretched is a curve, too. Only
// the prior of kappa prefers one of them, the one that is nearer to the believed bed, which on ground that
// hardens is too soft. Therefore D is not fitted. The normal equations N x = m are those without D, and D
// keeps the distribution that it had before the stride (cut model, Plummer 2015, Statistics and Computing 25,
// 37). It changes m by B D, D of each cell, so with S = B cov(D) B^T the estimate has the covariance
//   N^-1 + N^-1 S N^-1
// F' in B is taken from the previous posterior, in three passes.
// The measured force depends on the measured acceleration, F = M_f (a + g) + ..., so the likelihood of c has
// the Jacobian prod (1 + c m_a / M_f). Without it a rough curve would be interpreted as little added mass.
// lambda is the drag that does not fade as the cone of grains is complete. In a single stride it has the form
// of a curve, because the foot slows down with depth. In several strides it is the same, and the errors of
// the depth differ. So c and lambda are estimated by generalised least squares in which D of each stride is
// noise with its covariance, V = W^-1 + F' cov(D) F'^T + f's part: G t = X^T V^-1 y. The prior of kappa there
// is that of the best point of the grid. Both are held in the fit of the curve. Let h be the column of (G +
// prior)^-1 of such a coefficient, a its column of N, and var its variance. The covariance of the moment m,
// less a times the coefficient's error, is
//   N + S - Q a^T - a Q^T + var a a^T,  Q = (N - G) h
// because cov(X^T W y, X^T V^-1 y) = X^T W X. The prior of kappa counts once for each place there: strides of
// one set-up differ only by their errors, and would otherwise add up what the model of the errors gets wrong.
// As kappa departs from its prior once only, n places add n (n - 1) h^T P h to the variance.
// e is estimated and held in the same way. In the fit of the curve, whose weights do not count what differs
// from place to place, it would follow these differences, by twice its prior standard deviation after ten
// places on wet ground.
// Places prepared alike differ in strength. The curve of one of them is that of the mean place times 1 + u_1
// + u_2 exp(-z/dz0), in its tangent stiffness: all of the ground, and a layer at its surface, such as one
// that is wet or dry. With U the change of kappa for a unit of both and Theta = diag(var u_1, var u_2), the
// information G of a place between strides becomes G - G U (Theta^-1 + U^T G U)^-1 U^T G. Each element of
// Theta is integrated over a grid by its marginal likelihood. With N_p of each place and n places the error
// of the mean is
//   N^-1 sum N_p U u_p - U sum u_p / n
// because the common curve is the mean of those of the places. It vanishes if all places have equal weight.
// With one place the curve is that of the place, and U is left out.
// The lag, and a part of d, are the same on all places: contact is detected later on soft ground and at low
// speed. No number of strides averages them out, so S holds their products between strides.
// A layer boundary is a jump of kappa, a crust an outlier. Therefore the innovations of kappa have Student's
// distribution (variances by expectation maximisation), and a cell that the curve does not fit at a level of
// 1 % over all strides gets less weight and a wider band. The residuals for this are those that remain after
// the best prediction of the errors of this stride alone, of D, f and the strength of its place. The band of
// one place includes the bed's own fluctuation, which is part of its curve. From the second place of a ground
// prepared alike on, the curve is the one common to all places; their fluctuations and the noise of their
// depths are noise that averages out. Between strides N, m and S are kept, and f is integrated out: the
// posterior of a stride is the prior of the next. A foot that lands in its crater begins at the depth where
// the previous stride ended,
//   d of the next stride = D at the crater's deepest point + N(0, landing^2)
// so the variance of D there and its covariance with the change of m are kept, too. All memory is bounded and
// nothing is allocated.
namespace sandhopper {

// Points of a reported curve: the middle and the end of every cell.
inline constexpr std::size_t kProfilePoints = 2 * kProfileCells;
inline constexpr double kProfilePoint_m = 0.5 * kProfileCell_m;

struct StrengthProfile {
  std::uint32_t stride = 0;  // the last stride included; 0: none
  std::int32_t samples = 0;  // number of samples of this stride
  double depth_min_m = 0.0;  // depths visited by the trial so far
  double depth_max_m = 0.0;
  std::array<float, kProfilePoints> force_N{};  // at 1.25 mm, 2.5 mm, ...
  std::array<float, kProfilePoints> force_sd_N{};
  std::array<float, kProfileCells> tangent_N_per_m{};  // mean over each cell
  std::array<float, kProfileCells> tangent_sd_N_per_m{};
  std::array<float, kProfileCells> observations{};  // number of independent observations in each cell, all
                                                    // strides
  double added_mass_factor = 0.0;
  double added_mass_factor_sd = 0.0;
  double smoothness_m = 0.0;     // posterior mean of L
  double spread_relative = 0.0;  // posterior mean of s
  double joint_friction_N = 0.0;
  double chi_squared = 0.0;  // chi-squared per independent observation

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("stride", self.stride);
    visit("samples", self.samples);
    visit("depth_min_m", self.depth_min_m);
    visit("depth_max_m", self.depth_max_m);
    visit("force_N", self.force_N);
    visit("force_sd_N", self.force_sd_N);
    visit("tangent_N_per_m", self.tangent_N_per_m);
    visit("tangent_sd_N_per_m", self.tangent_sd_N_per_m);
    visit("observations", self.observations);
    visit("added_mass_factor", self.added_mass_factor);
    visit("added_mass_factor_sd", self.added_mass_factor_sd);
    visit("smoothness_m", self.smoothness_m);
    visit("spread_relative", self.spread_relative);
    visit("joint_friction_N", self.joint_friction_N);
    visit("chi_squared", self.chi_squared);
  }
};

// Chi-squared value with the same cumulative probability as this normal quantile (Wilson & Hilferty 1931).
double chi_squared_quantile(double degrees, double normal_quantile) noexcept;

// A value and its standard deviation.
struct ProfilePoint {
  double value = 0.0;
  double sd = 0.0;
  double low() const noexcept { return value - 1.959964 * sd; }
  double high() const noexcept { return value + 1.959964 * sd; }
};

// Force at a depth, linear between the points; NaN beyond the last.
ProfilePoint force_at(const StrengthProfile& profile, double depth_m) noexcept;
// Tangent stiffness of the cell that contains this depth; NaN beyond the last.
ProfilePoint tangent_at(const StrengthProfile& profile, double depth_m) noexcept;

// Estimates the profile from all strides of a trial so far.
class ProfileSolver {
 public:
  static constexpr std::size_t kTerms = kProfileCells + 4;  // kappa, c, e, b, lambda

  static constexpr std::size_t kAddedMass = kProfileCells, kScale = kProfileCells + 1,
                               kIntercept = kProfileCells + 2, kSteadyDrag = kProfileCells + 3;

  template <std::size_t N>
  using Matrix = std::array<double, N * N>;
  template <std::size_t N>
  using Vector = std::array<double, N>;

  explicit ProfileSolver(const StiffnessConfig& config);

  void restart() noexcept;  // starts a new trial on other ground
  // `stride` is its number in the trial, from 1, which restarts the solver. kFreshGround means the first
  // stride of another trial on ground prepared alike.
  static constexpr std::uint32_t kFreshGround = 0;
  void add(const ProfileSums& sums, std::uint32_t stride) noexcept;
  const StrengthProfile& profile() const noexcept { return profile_; }
  const StiffnessConfig& config() const noexcept { return config_; }
  // Information of the strides on all terms, without their prior. The depth errors are integrated out, for
  // each stride by itself.
  const Matrix<kTerms>& normal() const noexcept { return between_.normal; }
  const Vector<kTerms>& moment() const noexcept { return between_.moment; }
  double believed_N_per_m(std::size_t cell) const noexcept { return believed_N_per_m_[cell]; }
  double intercept_N_per_m(std::size_t cell) const noexcept { return intercept_N_per_m_[cell]; }
  // Line of the joint fit over all strides that have one; NaN if none has.
  struct Line {
    double value_N_per_m, ci95_low_N_per_m, ci95_high_N_per_m;
  };
  Line line() const noexcept;
  const ReloadingPosterior& reloading() const noexcept { return reloading_; }
  // Number of cells of the last stride that no curve fits, at a level of 1 % for all cells together.
  std::size_t broken_cells() const noexcept { return broken_cells_; }

  // Depth at which a foot that lands on new ground with this speed is found in contact.
  static constexpr std::size_t kContactCells = 2;
  struct ContactDepth {
    double mean_m = 0.0, variance_m2 = 0.0;
    // Change of the mean for a change of the tangent stiffness of the first cells [m per N/m].
    std::array<double, kContactCells> of_slope{};
  };
  ContactDepth contact_depth(double speed_mps, double added_mass_kg_per_m) const noexcept;

  // Force at a depth; NaN beyond the last cell. `narrowable` leaves out of the band the curve's variation
  // within a cell, such as that of a crust or a sharp boundary, and the errors that all strides share: no
  // stride narrows them.
  enum class Band { whole, narrowable };
  ProfilePoint force_N(double depth_m, Band band = Band::whole) const noexcept;

 private:
  struct Information {
    Matrix<kTerms> normal{};
    Vector<kTerms> moment{};
    std::array<Vector<kTerms>, kProfileCells> of_depth{};  // B: change of the moment for a unit of each D
    Vector<kProfileCells> depth_normal{};                  // of each D itself; zero: no sample
    Vector<kProfileCells> depth_moment{};
    Vector<kProfileCells> time_s{}, change_mps{};  // mean time and change of speed since contact
    // Part of f, which belongs to this stride alone.
    Vector<kTerms> with_friction{};
    Vector<kProfileCells> friction_of_depth{};
    double friction_normal = 0.0, friction_moment = 0.0;
  };
  struct Posterior {
    Vector<kTerms> mean{};
    Matrix<kTerms> covariance{};
    Matrix<kTerms> gain{};    // N^-1: change of the mean for a unit change of the moment
    Matrix<kTerms> shared{};  // the part of the covariance that all strides share
    double smoothness_m = 0.0, spread = 0.0;
  };
  // Errors of the depth, which are not fitted.
  struct DepthErrors {
    Matrix<kTerms> moment{};      // S
    Vector<kTerms> with_depth{};  // covariance of the moment's change and D
    // Change of the moment, over all strides, for a unit of the surface's error that all places share, and of
    // l.
    Vector<kTerms> of_surface{}, of_lag{};
    Vector<kTerms> of_earlier_surface{};     // the same of the places before this one
    double mean_m = 0.0, variance_m2 = 0.0;  // of D
  };
  // Normal equations of all strides in which D of each stride is noise with its covariance.
  struct Between {
    Matrix<kTerms> normal{};
    Vector<kTerms> moment{};
    Vector<kTerms> of_surface{}, of_lag{};  // as in DepthErrors
    double log_likelihood = 0.0;            // of the data, up to a constant
  };
  static constexpr std::size_t kStrengths = 2;  // of a place
  static constexpr std::size_t kPlaceGrid = 3;  // points of the grid of Theta
  using PlaceTerms = std::array<Vector<kTerms>, kStrengths>;
  // c, lambda and e from the comparison of strides at different speeds, and their errors. They are held in
  // the fit of the curve. `with_moment`: Q. `of_error`: change of the curve's moment for a unit of the error.
  static constexpr std::array<std::size_t, 3> kHeld{kAddedMass, kSteadyDrag, kScale};
  struct Held {
    std::array<double, kHeld.size()> mean{};
    Matrix<kHeld.size()> covariance{};
    std::array<Vector<kTerms>, kHeld.size()> with_moment{}, of_error{};
    std::array<double, kHeld.size()> of_surface{},
        of_lag{};  // change for a unit of the errors that all strides share
    // Change for a unit of a strength on all places.
    std::array<std::array<double, kStrengths>, kHeld.size()> of_strength{};
    bool fitted = false;  // otherwise lambda is zero, and c and e belong to the fit of the curve
    bool holds(std::size_t term) const noexcept {
      return term == kSteadyDrag || (fitted && (term == kAddedMass || term == kScale));
    }
  };
  Information information_of(const ProfileSums& sums) const noexcept;
  void depend_on_contact(Information& information) const noexcept;
  void integrate_friction(Information& information) const noexcept;
  void add_kept(Information& information) const noexcept;
  double add_shared_prior(Information& information, double smoothness_m, double spread) const noexcept;
  struct Innovation {
    double here, above;
  };
  Innovation innovation(std::size_t cell, double keep, double fresh, double spread) const noexcept;
  void take_jumps(double smoothness_m, double spread, const Matrix<kTerms>& covariance,
                  const Vector<kTerms>& mean) noexcept;
  void integrate(const Information& information, bool last) noexcept;
  Matrix<kTerms> covariance_of(const Matrix<kTerms>& gain, const Matrix<kTerms>& errors) const noexcept;
  void add_error(const Matrix<kTerms>& gain, const Vector<kTerms>& of_error, double sd,
                 Matrix<kTerms>& covariance) const noexcept;
  void take_friction(const Information& information) noexcept;
  void add_between(const Information& own) noexcept;
  PlaceTerms place_shapes() const noexcept;
  double place_variance(std::size_t point, std::size_t strength) const noexcept;
  void add_place(const Between& place, const PlaceTerms& shapes, std::size_t point,
                 Between& sum) const noexcept;
  void begin_place() noexcept;
  double log_evidence(const Between& all, const Information& prior) const noexcept;
  void integrate_places() noexcept;
  void take_strength(const Information& own) noexcept;
  void add_strength_errors(Matrix<kTerms>& errors) const noexcept;
  void refer_to_mean_place(const Matrix<kTerms>& gain, Matrix<kTerms>& covariance) const noexcept;
  Vector<kProfileCells> own_residuals_squared(const ProfileSums& sums, const Information& own) const noexcept;
  void take_held(const Information& information) noexcept;
  void hold(Information& information) const noexcept;
  Matrix<kTerms> moment_errors() const noexcept;
  Matrix<kTerms> shared_errors(const Matrix<kTerms>& gain) const noexcept;
  double solve_at(std::size_t grid_point, const Information& data, Posterior& posterior,
                  bool with_gain) const noexcept;
  void take_responses(const ProfileSums& sums, const Information& information) noexcept;
  void take_line(const ProfileSums& sums) noexcept;
  // Force of the ground's inertia on a foot at the surface, over the square of its speed.
  struct Blow {
    double mean_kg_per_m, sd_kg_per_m;
    double odds_of_none;  // odds that the ground has no inertia
  };
  Blow blow_at_contact(double added_mass_kg_per_m) const noexcept;
  ContactDepth found_at(double speed_mps, double blow_N) const noexcept;
  void begin_depth_errors(bool in_crater) noexcept;
  void expect_contact(const ProfileSums& sums) noexcept;
  double mean_depth_error_m(double change_mps) const noexcept;
  void subtract_mean_depth_error(Information& information) const noexcept;
  static void subtract_depth_error(Information& information, const Vector<kProfileCells>& mean_m) noexcept;
  double depth_covariance_m2(double time_s, double change_mps, double other_s,
                             double other_mps) const noexcept;
  Matrix<kProfileCells> depth_covariance(const Information& information) const noexcept;
  double wander_m2(const ProfileCell& cell) const noexcept;
  void take_depth_errors(const Information& information) noexcept;
  void end_depth_errors(const Information& information, const ProfileSums& sums) noexcept;
  void keep(const Information& information) noexcept;
  void take_slopes() noexcept;
  void report(const ProfileSums& sums, std::uint32_t stride) noexcept;
  void weigh_cells(const ProfileSums& sums, const Information& information, bool jumps_known) noexcept;
  double cell_variance_N2(const ProfileSums& sums, std::size_t cell) const noexcept;
  std::array<double, kProfileFeatures> residual_features(std::size_t cell) const noexcept;
  double scatter_squared(const ProfileSums& sums, std::size_t cell) const noexcept;
  ProfilePoint tangent_N_per_m(std::size_t cell) const noexcept;
  double slope_change_squared(std::size_t cell) const noexcept;
  double residual_squared(const ProfileSums& sums, std::size_t cell) const noexcept;

  // Sums over the strides in a cell [observations, N^2]: squared residuals, and their expectation.
  struct Misfit {
    double observations = 0.0, found_N2 = 0.0, expected_N2 = 0.0;
  };
  Misfit misfit_with(const Misfit& stride, std::size_t cell) const noexcept;

  StiffnessConfig config_;
  ProfileConfig prior_;
  std::array<double, kProfileCells> believed_N_per_m_{};   // mean tangent stiffness of each cell
  std::array<double, kProfileCells> intercept_N_per_m_{};  // slope of k (1 - exp(-z/dz0))
  std::array<double, kProfileCells> slope_N_per_m_{};      // tangent stiffness of the previous posterior
  std::array<double, kProfileCells> noise_factor_{};       // variance of a cell's samples relative to that of
                                                           // their weights
  std::array<double, kProfileCells> unresolved_N2_{};  // variance that is attributed to the curve within a
                                                       // cell
  std::array<Misfit, kProfileCells> misfit_{}, stride_misfit_{};  // of the previous strides, of this one
  double begins_m_ = 0.0;                                         // mean of D at the beginning of this stride
  Vector<kTerms> begins_of_{};                                    // its change for a unit of each term
  double friction_N_ = 0.0;                                       // f of this stride
  int places_ = 0;                                                // number of places on ground prepared alike
  std::array<double, kProfileCells> jump_{};  // variance of each innovation relative to its prior
  std::array<Vector<kTerms>, kProfileCells> response_{};
  Matrix<kTerms> kept_normal_{};
  Vector<kTerms> kept_moment_{};
  DepthErrors kept_errors_{}, errors_{};  // before and after the moments of this stride
  Between place_{}, kept_place_{};        // of this place with this stride, and without it; Theta is left out
  // Sums over the places before, at each point of the grid, and over all places, in the mean over the grid.
  std::array<Between, kPlaceGrid> earlier_{};
  Between between_{};
  std::array<double, kStrengths> place_variance_{};  // posterior mean of Theta; zero for one place
  // N_p U of this place with this stride and without it; of the places before, their sum and the sum of their
  // products with themselves.
  PlaceTerms strength_{}, kept_strength_{}, earlier_strength_{};
  std::array<Matrix<kTerms>, kStrengths> earlier_strength_squares_{};
  Held held_{};
  std::size_t broken_cells_ = 0;
  std::size_t first_cell_ = 0;  // first cell of the last stride's new ground
  ReloadingPosterior reloading_;
  double line_weight_ = 0.0, line_sum_ = 0.0, line_degrees_ = 0.0;  // sums over the strides' joint fits
  Posterior posterior_{};
  StrengthProfile profile_{};
};

}  // namespace sandhopper
