#include "drivers/adc/iio_load_cell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "config/load.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {
namespace {

// The files of an IIO device.
class IioFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    config_.converter = LoadCellConverter::iio;
    config_.iio = IioConverterConfig{.device = folder_.string()};
    config_.latency_s = 0.0;
    write("name", "hx711\n");
    write("in_voltage0_scale", "0.000002980\n");  // mV
    write("in_voltage0_raw", "8388608\n");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::string start_error() {
    try {
      IioLoadCell{config_};
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("iio_" + std::to_string(::getpid()));
  LoadCellConfig config_;
};

TEST_F(IioFolder, RawTimesScaleAreMillivolts) {
  config_.scale_N_per_V = 2000.0;
  config_.zero_V = 0.005;
  IioLoadCell cell(config_);
  EXPECT_EQ(cell.chip(), "hx711");
  LoadCellSample sample;
  ASSERT_TRUE(cell.acquire(sample));
  EXPECT_NEAR(sample.force_N, 2000.0 * (8388608 * 2.98e-9 - 0.005), 1e-6);
  EXPECT_EQ(sample.samples, 1U);
  write("in_voltage0_raw", "-100\n");
  ASSERT_TRUE(cell.acquire(sample));
  EXPECT_NEAR(sample.force_N, 2000.0 * (-100 * 2.98e-9 - 0.005), 1e-9);
  EXPECT_EQ(sample.samples, 2U);
}

TEST_F(IioFolder, TheCommonScaleIsTakenWhereTheChannelHasNone) {
  std::filesystem::remove(folder_ / "in_voltage0_scale");
  write("in_voltage_scale", "1.5\n");  // value that the NAU7802's driver gives
  LoadCellSample sample;
  config_.scale_N_per_V = 1.0;
  ASSERT_TRUE(IioLoadCell(config_).acquire(sample));
  EXPECT_NEAR(sample.force_N, 8388608 * 1.5e-3, 1e-6);
}

TEST_F(IioFolder, AReadThatFailsIsCounted) {
  IioLoadCell cell(config_);
  write("in_voltage0_raw", "");
  LoadCellSample sample;
  EXPECT_FALSE(cell.acquire(sample));
  EXPECT_EQ(cell.counters().failed_transfers, 1U);
}

TEST_F(IioFolder, TheBoardsFileChoosesTheConverter) {
  config_.scale_N_per_V = 2000.0;
  const auto cell = open_load_cell(config_);
  LoadCellSample sample;
  ASSERT_TRUE(cell->acquire(sample));
  EXPECT_NEAR(sample.force_N, 2000.0 * 8388608 * 2.98e-9, 1e-6);
  EXPECT_EQ(cell->counters().failed_transfers, 0U);
  config_.converter = LoadCellConverter::ads1115;
  config_.device = "/nowhere/i2c";
  try {
    open_load_cell(config_);
    FAIL() << "an ADS1115 that is not there";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/nowhere/i2c"));
  }
}

TEST_F(IioFolder, StartErrorsNameCauseAndCure) {
  using ::testing::HasSubstr;
  config_.iio->channel = 3;
  EXPECT_THAT(start_error(), HasSubstr("in_voltage3_raw"));
  config_.iio->channel = 0;
  write("in_voltage0_scale", "none\n");
  EXPECT_THAT(start_error(), HasSubstr("\"none\""));
  config_.iio->device = "/nowhere";
  EXPECT_THAT(start_error(), HasSubstr("hx711 or nau7802"));
}

std::string config_error(const std::string& text) {
  try {
    load_text<LoadCellConfig>("linux.toml", text, MissingKeys::use_default);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(LoadCellConverters, TheKeyAndItsTableBelongTogether) {
  using ::testing::HasSubstr;
  EXPECT_THAT(config_error("converter = \"iio\"\n"), HasSubstr("needs a table [load_cell.iio]"));
  EXPECT_EQ(config_error("converter = \"iio\"\n[iio]\nrate_Hz = 10\n"), "");
  const std::string ads = "converter = \"ads1115\"\n[ready]\nline = \"RDY\"\n";
  EXPECT_EQ(config_error(ads), "");
  EXPECT_EQ(config_error("[ready]\nline = \"RDY\"\n"), "") << "files of before have no such key";
  EXPECT_THAT(config_error(ads + "[iio]\nrate_Hz = 10\n"), HasSubstr("is not used by an ADS1115"));
  EXPECT_THAT(config_error("converter = \"hx711\"\n[iio]\nrate_Hz = 10\n"), HasSubstr("iio"));
  EXPECT_THAT(config_error("converter = \"iio\"\n[iio]\nrate_Hz = 321\n"), HasSubstr("rate_Hz"));
}

}  // namespace
}  // namespace sandhopper
