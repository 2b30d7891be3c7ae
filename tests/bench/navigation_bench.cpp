// The ten-minute drive of the accuracy claims: figures and how much faster than real time it runs
// on one thread, by processor time. Prints a table; tests/inertial checks a shorter drive.

#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "inertial/books_robot.hpp"
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

/// Ten drives of the book's robot with the presets as they are shipped: the exercise's finding.
void report_robot() {
  constexpr int kSeeds = 10;
  constexpr double kSeconds = 60;
  constexpr double kFrom = 10;
  using inertial::Trigger;
  inertial::NavigationOptions paired = testing::shipped_two_frame(Trigger::kGnssAndWheels);
  paired.pairing = inertial::Pairing::kPaired;
  inertial::NavigationOptions book = testing::shipped_two_frame(Trigger::kGnssAndWheels);
  book.gnss.level_pose = true;
  book.wheels.form = inertial::WheelForm::kWorldVelocity;
  const std::vector<std::pair<std::string, inertial::NavigationOptions>> presets{
      {"gins-gnss", testing::shipped_two_frame(Trigger::kGnss)},
      {"gins-odom", testing::shipped_two_frame(Trigger::kGnssAndWheels)},
      {"gins-odom-paired", paired},
      {"gins-book", book},
      {"gins-window", testing::shipped_window()}};
  std::printf("\nthe book's robot, %d drives of %.0f s, as shipped: means of the drives\n", kSeeds,
              kSeconds);
  std::printf("%-22s %10s %10s %10s %10s %10s %9s\n", "estimator", "rmse m", "rough m", "jumps>5cm",
              "jump 95 % m", "largest m", "restarts");
  for (const auto& [name, options] : presets) {
    testing::NavigationFigures mean;
    double many = 0;
    double p95 = 0;
    double most = 0;
    std::size_t restarts = 0;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      const testing::SimulatedDrive drive = testing::books_robot(seed, kSeconds);
      inertial::Navigation navigation(options, drive.mounts);
      const auto frames = testing::run(navigation, drive);
      const auto figures = testing::figures(frames, drive, navigation, kFrom);
      const testing::Jumps jumps = testing::jumps_of(frames, kFrom);
      mean.position_rmse_m += figures.position_rmse_m / kSeeds;
      mean.roughness_m += figures.roughness_m / kSeeds;
      many += static_cast<double>(jumps.many) / kSeeds;
      p95 += jumps.p95_m / kSeeds;
      most += jumps.most_m / kSeeds;
      for (const auto& frame : frames) restarts += frame.restarted ? 1 : 0;
    }
    std::printf("%-22s %10.4f %10.4f %10.1f %10.4f %10.4f %9zu\n", name.c_str(),
                mean.position_rmse_m, mean.roughness_m, many, p95, most, restarts);
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
  inertial::NavigationOptions book = testing::two_frame(inertial::Trigger::kGnssAndWheels, sensors);
  book.gnss.level_pose = true;
  book.wheels.form = inertial::WheelForm::kWorldVelocity;
  report("gins-book", book, with_headings, seconds);
  inertial::NavigationOptions window = testing::window(sensors);
  report("gins-window", window, drive, seconds);
  window.outage.spells_s = {10, 30, 60};
  window.outage.first_s = 60;
  report("gins-window, outages", window, drive, seconds);
  window.wheels.use = false;
  report("  without wheels", window, drive, seconds);
  report_robot();
  std::printf("NEES of 15 unknowns, mean of %d drives: %.2f, 95 %% bounds %.2f to %.2f\n",
              testing::kNeesDrives, testing::mean_nees(), testing::kLeastNees, testing::kMostNees);
}
