#pragma once

#include <string>

#include "traverse/sensors/gnss_fix.hpp"

namespace traverse::app {

/// Fixes as a CSV file, with headings and standard deviations.
class GnssTable {
 public:
  void add(const sensors::GnssFix& fix);
  bool empty() const { return rows_.empty(); }
  /// Header and rows; cells of what a fix does not have are empty.
  std::string text() const;

 private:
  std::string rows_;
};

}  // namespace traverse::app
