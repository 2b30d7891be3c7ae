// The figures of the accuracy claims on comma2k19, in the folder that TRAVERSE_TEST_DATA names. One
// outage says little: moved by 0.3 s its error at the end changes by a half. So there is one from
// each of 25 moments too.

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "pipeline/comma2k19_figures.hpp"

namespace {

using namespace traverse;

void print(const char* name, const testing::PathError& e) {
  std::printf("%-42s %6zu %10.3f %8.3f %8.4f %8.2f %8.3f\n", name, e.poses, e.horizontal_rmse_m,
              e.rmse_m, e.roughness_m, e.shift.head<2>().norm(), e.longer_percent);
}

/// What one outage of 10 s ends with, from 25 moments, 1.5 s apart, 8 s after the start and later.
void print_outages(const char* name, dataset::Source& recording,
                   std::vector<std::string> settings) {
  constexpr int kMoments = 25;
  settings.insert(settings.end(), {"outage.spells_s=[10]", ""});
  double sum = 0;
  double squares = 0;
  for (int k = 0; k < kMoments; ++k) {
    settings.back() = "outage.first_s=" + std::to_string(8 + 1.5 * k);
    for (const auto& decision : testing::navigate(recording, settings).decisions) {
      if (decision.name.find("without GNSS") == std::string::npos) continue;
      const double error = std::stod(decision.value);  // "1.232 m off the first fix after it, ..."
      sum += error;
      squares += error * error;
    }
  }
  std::printf("%s, 10 s without GNSS from each of %d moments: mean %.3f m, rms %.3f m\n", name,
              kMoments, sum / kMoments, std::sqrt(squares / kMoments));
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
  print_outages("GNSS and IMU", *source, {"wheels.use=false"});
  print_outages("GNSS, IMU and wheels", *source, {});
}
