// The ten-minute drive of the accuracy claims: figures and how much faster than real time it runs
// on one thread, by processor time. Prints a table; tests/inertial checks a shorter drive.

#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "inertial/navigation_figures.hpp"
#include "inertial/simulated_vehicle.hpp"

namespace {

using namespace traverse;

void report(const std::string& name, const inertial::NavigationOptions& options,
            const testing::SimulatedDrive& drive, double seconds) {
  inertial::Navigation navigation(options, drive.mounts);
  const std::clock_t begin = std::clock();
  const auto frames = testing::run(navigation, drive);
  const double took = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const testing::NavigationFigures f = testing::figures(frames, drive, navigation, 30);
  std::printf("%-22s %7zu %10.4f %9.4f %10.4f %10.1f\n", name.c_str(), frames.size(),
              f.position_rmse_m, f.heading_rmse_deg, f.roughness_m, seconds / took);
  for (const auto& [what, count] : navigation.events()) {
    std::printf("    %zu x %s\n", count, what.c_str());
  }
  for (const auto& outage : navigation.outages()) {
    std::printf("    outage of %.0f s: %.3f m after %.0f m, %.3f %% (own sigma %.3f m)\n",
                outage.seconds, outage.error_m, outage.distance_m,
                100 * outage.error_m / outage.distance_m, outage.sigma_m);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::stod(argv[1]) : 600;
  const testing::SimulatedSensors sensors;
  const testing::SimulatedDrive drive = testing::simulate({}, sensors, seconds);
  std::printf("%-22s %7s %10s %9s %10s %10s\n", "estimator", "frames", "rmse m", "hdg deg",
              "rough m", "x realtime");
  testing::SimulatedSensors two_antennas = sensors;
  two_antennas.heading_sigma_deg = 0.2;
  const testing::SimulatedDrive with_headings = testing::simulate({}, two_antennas, seconds);
  report("gins-gnss", testing::two_frame(inertial::Trigger::kGnss, sensors), with_headings,
         seconds);
  report("gins-odom", testing::two_frame(inertial::Trigger::kGnssAndWheels, sensors), with_headings,
         seconds);
  inertial::NavigationOptions paired =
      testing::two_frame(inertial::Trigger::kGnssAndWheels, sensors);
  paired.pairing = inertial::Pairing::kPaired;
  report("gins-odom-paired", paired, with_headings, seconds);
  inertial::NavigationOptions window = testing::window(sensors);
  report("gins-window", window, drive, seconds);
  window.outage.spells_s = {10, 30, 60};
  window.outage.first_s = 60;
  report("gins-window, outages", window, drive, seconds);
  window.wheels.use = false;
  report("  without wheels", window, drive, seconds);
  std::printf("NEES of 15 unknowns, mean of %d drives: %.2f, 95 %% bounds %.2f to %.2f\n",
              testing::kNeesDrives, testing::mean_nees(), testing::kLeastNees, testing::kMostNees);
}
