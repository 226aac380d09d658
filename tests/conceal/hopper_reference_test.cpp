// Compares the hopper of the concealed campaigns with the noise-free strides of
// ../shared/data/reference_strides. A campaign with nothing hidden must behave as the default belief of a
// hopper.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tools/conceal/hopper/simulate.hpp"

namespace sandhopper::conceal::hopper {
namespace {

const std::filesystem::path kStrides = SANDHOPPER_SOURCE_DIR "/../shared/data/reference_strides";

using Columns = std::map<std::string, std::vector<double>>;

Columns read_csv(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line, cell;
  std::getline(in, line);
  std::vector<std::string> names;
  for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
  Columns columns;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    for (const auto& name : names) std::getline(row, cell, ','), columns[name].push_back(std::stod(cell));
  }
  return columns;
}

World exact() {
  World w;
  w.sensors.ideal = true;
  return w;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  const auto n = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < n; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(n));
}

std::vector<double> each_cycle(const Trace& trace, std::size_t rows) {
  std::vector<double> values(rows);
  for (std::size_t i = 0; i < rows; ++i) values[i] = trace.values[4 * i];
  return values;
}

std::vector<double> mean_of_cycle(const Trace& trace, std::size_t rows) {
  std::vector<double> values(rows);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < 4; ++k) values[i] += trace.values[4 * i + k] / 4.0;
  return values;
}

class Stride : public testing::TestWithParam<const char*> {};

TEST_P(Stride, FollowsTheReference) {
  const auto file = kStrides / (std::string(GetParam()) + ".csv");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no reference strides at " << kStrides;
  const auto reference = read_csv(file);
  const auto rows = reference.at("t_s").size();
  conceal::Setup setup;
  setup.keys["kind"] = "hop";
  setup.keys["compression_stiffness_N_per_m"] = std::stod(file.stem().string().substr(7));
  setup.keys["release_height_m"] = reference.at("foot_z_m").front();
  setup.keys["duration_s"] = 1e-3 * static_cast<double>(rows);
  const auto run = simulate(exact(), setup, Random(1));
  const double body_m = rms_difference(each_cycle(run.body_m, rows), reference.at("body_z_m"));
  const double foot_m = rms_difference(each_cycle(run.foot_m, rows), reference.at("foot_z_m"));
  const double force_N = rms_difference(mean_of_cycle(run.contact_N, rows), reference.at("contact_force_N"));
  std::printf("%s: body %.1f um, foot %.1f um, force %.3f N rms\n", GetParam(), 1e6 * body_m, 1e6 * foot_m,
              force_N);
  EXPECT_LT(body_m, 0.1e-3);
  EXPECT_LT(foot_m, 0.2e-3);
  EXPECT_LT(force_N, 0.4);
}

INSTANTIATE_TEST_SUITE_P(All, Stride,
                         testing::Values("v0.20_k250", "v0.20_k375", "v0.20_k500", "v0.45_k250", "v0.45_k375",
                                         "v0.45_k500", "v0.70_k250", "v0.70_k375", "v0.70_k500", "v1.00_k250",
                                         "v1.00_k375", "v1.00_k500", "v1.20_k250", "v1.20_k375",
                                         "v1.20_k500"));

}  // namespace
}  // namespace sandhopper::conceal::hopper
