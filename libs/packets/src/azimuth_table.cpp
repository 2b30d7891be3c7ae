#include "azimuth_table.hpp"

#include <cmath>
#include <memory>
#include <numbers>

namespace traverse::packets {

const AzimuthTable& azimuth_table() {
  static const std::unique_ptr<const AzimuthTable> table = [] {
    auto made = std::make_unique<AzimuthTable>();
    for (std::size_t i = 0; i < AzimuthTable::kTurn; ++i) {
      const double azimuth =
          static_cast<double>(i) * std::numbers::pi / (AzimuthTable::kTurn / 2.0);
      made->entries[i] = {static_cast<float>(std::sin(azimuth)),
                          static_cast<float>(std::cos(azimuth))};
    }
    return made;
  }();
  return *table;
}

}  // namespace traverse::packets
