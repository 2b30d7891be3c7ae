#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "checks/check.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::array<CodeMeaning, 1> kGnssTimeCodes{
    {{"gnss_late",
      "Distances and turns between fixes against those of lidar odometry, wheels or gyro, shifted "
      "in "
      "time by up to 30 s: more than 0.2 s away they agree better by three tenths and four "
      "sigma."}}};

void look_at_delay(const View& view, std::vector<Finding>& findings) {
  constexpr double kCertainlyAnotherClock_s = 1;
  for (const auto& [label, receiver] : view.receivers) {
    if (!receiver.delay) continue;
    const Delay& delay = receiver.delay->delay;
    const double seconds = std::abs(delay.seconds);
    findings.push_back(
        {"gnss_late", seconds > kCertainlyAnotherClock_s ? Severity::kRefuse : Severity::kWarn,
         label,
         fmt::format("its fixes go best with {} as places of {:.2f} s {} their stamps: the mean "
                     "difference is then {:.1f} %, else {:.1f} %, over {} pieces",
                     receiver.delay->against, seconds, delay.seconds > 0 ? "before" : "after",
                     100 * delay.there.mean, 100 * delay.at_zero.mean, delay.there.pieces),
         // The clocks of GPS and UTC since 2017.
         std::abs(seconds - 18) < 0.5
             ? std::string("One clock is GPS time, the other UTC: 18 leap seconds lie between")
             : fmt::format("At 10 m/s the path and the fixes would be {:.1f} m apart",
                           10 * seconds),
         fmt::format("--recording gnss.delay_s={:.2f}", delay.seconds)});
  }
}

}  // namespace

const Check kGnssTime{kGnssTimeCodes, look_at_delay};

}  // namespace traverse::plausibility
