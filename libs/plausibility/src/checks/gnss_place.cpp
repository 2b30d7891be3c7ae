#include <array>

#include <fmt/format.h>

#include "checks/check.hpp"
#include "comparison/place_judgement.hpp"

namespace traverse::plausibility {

namespace {

constexpr std::array<CodeMeaning, 4> kPlaceCodes{{
    {"gnss_radians",
     "All places within 1.57 of the equator and 3.14 of Greenwich, at sea, and "
     "distances between fixes by lidar or wheels that fit radians."},
    {"gnss_ddmm",
     "Distances between fixes 0.60 times those by lidar or wheels, within 10 %, and no "
     "fraction of a degree above 0.6: degrees and minutes."},
    {"gnss_swapped",
     "The course between fixes turns the other way than lidar, wheels or gyro, and "
     "distances or headings fit with latitude and longitude exchanged."},
    {"gnss_zero",
     "Fixes at latitude and longitude 0, of a receiver that has others elsewhere: it "
     "had no fix yet."},
}};

void look_at_places(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  for (const auto& [label, track] : evidence.receivers) {
    if (track.at_zero() > 0 && !track.fixes().empty()) {
      findings.push_back(
          {"gnss_zero",
           Severity::kWarn,
           label,
           fmt::format("{} fixes are at latitude 0, longitude 0, the others near {:.3f}, {:.3f}",
                       track.at_zero(), track.fixes().front().latitude,
                       track.fixes().front().longitude),
           "Before it has a fix a receiver writes zeros; they would be taken for a place thousands "
           "of kilometres away",
           {}});
    }
    const PlaceJudgement judgement = view.receivers.at(label).judgement;
    switch (judgement.reading) {
      case PlaceReading::kAsRead:
        break;
      case PlaceReading::kRadians:
        findings.push_back(
            {"gnss_radians", judgement.is_certain ? Severity::kRefuse : Severity::kWarn, label,
             judgement.figure, "Every distance between fixes would be 57 times too small",
             "--recording gnss.unit=rad"});
        break;
      case PlaceReading::kDegreesMinutes:
        findings.push_back(
            {"gnss_ddmm", Severity::kRefuse, label, judgement.figure,
             "Distances would be two fifths too small, with a jump at each full degree",
             "--recording gnss.unit=ddmm"});
        break;
      case PlaceReading::kSwapped:
        findings.push_back(
            {"gnss_swapped", Severity::kWarn, label, judgement.figure,
             "The path would be mirrored and stretched, and the other sensors rejected",
             "--recording gnss.order=longitude_latitude"});
        break;
    }
  }
}

}  // namespace

const Check kGnssPlace{kPlaceCodes, look_at_places};

}  // namespace traverse::plausibility
