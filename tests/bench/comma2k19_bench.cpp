// The figures of the accuracy claims on comma2k19, in the folder that TRAVERSE_TEST_DATA names.

#include <cstdio>

#include "pipeline/comma2k19_figures.hpp"

namespace {

using namespace traverse;

void print(const char* name, const testing::PathError& e) {
  std::printf("%-42s %6zu %10.3f %8.3f %8.4f %8.2f %8.3f\n", name, e.poses, e.horizontal_rmse_m,
              e.rmse_m, e.roughness_m, e.shift.head<2>().norm(), e.longer_percent);
}

}  // namespace

int main() {
  if (!std::filesystem::exists(testing::comma2k19())) {
    std::printf("%s is not there\n", testing::comma2k19().c_str());
    return 1;
  }
  std::printf("%-42s %6s %10s %8s %8s %8s %8s\n", "path", "poses", "horiz. m", "rmse m", "rough m",
              "shift m", "long %");
  const auto recorded = testing::open_comma2k19({"csv.gnss.period_s=0"});
  print("fixes as recorded", testing::path_error(testing::fixes_of(*recorded), *recorded));
  const auto source = testing::open_comma2k19();
  print("fixes on the receiver's clock", testing::path_error(testing::fixes_of(*source), *source));
  for (const auto& variant : testing::comma_variants()) {
    const auto run = testing::navigate(*source, variant.settings);
    print(variant.name.c_str(), testing::path_error(run.path, *source));
    for (const auto& decision : run.decisions) {
      if (decision.name.find("without GNSS") != std::string::npos) {
        std::printf("    %s: %s\n", decision.name.c_str(), decision.value.c_str());
      }
    }
  }
}
