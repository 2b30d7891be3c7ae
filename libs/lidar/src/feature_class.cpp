#include "traverse/lidar/feature_class.hpp"

#include <array>

namespace traverse::lidar {

std::string_view name_of(FeatureClass feature_class) {
  constexpr std::array<std::string_view, kFeatureClasses> kNames{"none", "sharp", "less sharp",
                                                                 "flat", "less flat"};
  return kNames[static_cast<std::size_t>(feature_class)];
}

}  // namespace traverse::lidar
