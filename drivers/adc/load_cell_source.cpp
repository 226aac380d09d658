#include "drivers/adc/load_cell_source.hpp"

#include "drivers/adc/iio_load_cell.hpp"
#include "drivers/adc/load_cell_reader.hpp"

namespace sandhopper {

std::unique_ptr<LoadCellSource> open_load_cell(const LoadCellConfig& config) {
  if (config.is_iio()) return std::make_unique<IioLoadCell>(config);
  return std::make_unique<LoadCellReader>(config);
}

}  // namespace sandhopper
