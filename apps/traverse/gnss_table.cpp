#include "gnss_table.hpp"

#include <cmath>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

namespace traverse::app {

void GnssTable::add(const sensors::GnssFix& fix) {
  rows_ += fmt::format("{},{},{},{},{}", to_text(fix.stamp), files::to_text(fix.latitude_deg),
                       files::to_text(fix.longitude_deg), files::to_text(fix.altitude_m),
                       fix.heading_deg ? files::to_text(*fix.heading_deg) : "");
  for (int axis = 0; axis < 3; ++axis) {
    rows_ += ",";
    if (fix.covariance_enu)
      rows_ += fmt::format("{:.4g}", std::sqrt((*fix.covariance_enu)(axis, axis)));
  }
  rows_ += "\n";
}

std::string GnssTable::text() const {
  return "stamp_s,latitude_deg,longitude_deg,altitude_m,heading_deg,east_m,north_m,up_m\n" + rows_;
}

}  // namespace traverse::app
