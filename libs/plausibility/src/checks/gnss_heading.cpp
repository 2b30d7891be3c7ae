#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "checks/check.hpp"
#include "comparison/place_judgement.hpp"

namespace traverse::plausibility {

namespace {

constexpr double kHeadingDegree = 57.29578;

// A vehicle goes where its body points to, give or take a few degrees of slip. A heading goes with
// the course, then, at a constant offset, which is that of the baseline of the two antennas.
constexpr std::array<CodeMeaning, 4> kHeadingCodes{{
    {"gnss_heading_from_east",
     "Headings of fixes against the course between them: heading minus "
     "course varies, heading plus course does not and is 90 degrees."},
    {"gnss_heading_counterclockwise", "The same with another sum than 90 degrees."},
    {"gnss_heading_rad", "The same, where headings in radians go with the course."},
    {"gnss_heading_offset",
     "Heading minus course is constant and more than 10 degrees from what is "
     "stated of the antennas' baseline: 180 of a baseline from front to back."},
}};

constexpr double kAgrees = 0.6;  // share of legs
// In streets at right angles to each other a wrong sense agrees on every other one.
constexpr double kMuchMore = 0.2;
constexpr double kMaxOffset_deg = 10;

std::optional<Finding> offset_finding(const HeadingAgreement& as_read, double stated_deg,
                                      const std::string& label) {
  const double off_deg =
      kHeadingDegree * wrapped((as_read.offset_deg + stated_deg) / kHeadingDegree);
  if (std::abs(off_deg) < kMaxOffset_deg) return std::nullopt;
  const double offset_deg = as_read.offset_deg > 179.5 ? 180 : -as_read.offset_deg;
  return Finding{
      "gnss_heading_offset",
      Severity::kWarn,
      label,
      fmt::format("headings are {:.1f} deg clockwise of the course on {:.0f} % of {} legs; "
                  "{:.1f} deg expected from the antennas' baseline",
                  as_read.offset_deg, 100 * as_read.share, as_read.legs, -stated_deg),
      std::abs(off_deg) > 180 - kMaxOffset_deg
          ? "The vehicle would be estimated to drive backwards (unless it does)"
          : "The path would go sideways between the fixes",
      fmt::format("--recording vehicle.gnss.heading_offset_deg={:.1f}", offset_deg)};
}

void look_at_headings(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  constexpr std::size_t kMinLegs = 8;
  for (const auto& [label, track] : evidence.receivers) {
    const Legs& legs = view.receivers.at(label).stamped;
    const HeadingAgreement as_read = heading_agreement(track, legs, 1, 1);
    if (as_read.legs < kMinLegs) continue;
    const Eigen::Matrix3d R = evidence.R_body(label);
    const double stated_deg = kHeadingDegree * std::atan2(R(1, 0), R(0, 0));  // counterclockwise
    const HeadingAgreement mirrored = heading_agreement(track, legs, -1, 1);
    const HeadingAgreement radians = heading_agreement(track, legs, 1, kHeadingDegree);
    const HeadingAgreement mirrored_radians = heading_agreement(track, legs, -1, kHeadingDegree);
    const double best = std::max({mirrored.share, radians.share, mirrored_radians.share});
    if (best < kAgrees || best < as_read.share + kMuchMore) {
      if (as_read.share >= kAgrees) {
        if (auto finding = offset_finding(as_read, stated_deg, label)) {
          findings.push_back(std::move(*finding));
        }
      }
      continue;
    }
    const auto found = [&, sensor = label](const char* code, const HeadingAgreement& with,
                                           const char* what, std::string statement) {
      findings.push_back(
          {code, Severity::kWarn, sensor,
           fmt::format("heading minus course agrees on {:.0f} % of {} legs; {} on {:.0f} %, and is "
                       "{:.0f} deg",
                       100 * as_read.share, as_read.legs, what, 100 * with.share, with.offset_deg),
           "Headings would turn the path away from the fixes", std::move(statement)});
    };
    if (mirrored.share == best) {
      const bool is_from_east = std::abs(wrapped((mirrored.offset_deg - 90) / kHeadingDegree)) <
                                kMaxOffset_deg / kHeadingDegree;
      found(is_from_east ? "gnss_heading_from_east" : "gnss_heading_counterclockwise", mirrored,
            "heading plus course",
            is_from_east ? "--recording gnss.heading=from_east"
                         : "--recording gnss.heading=counterclockwise");
    } else {
      const bool is_mirrored = mirrored_radians.share > radians.share;
      found("gnss_heading_rad", is_mirrored ? mirrored_radians : radians,
            is_mirrored ? "in radians, heading plus course" : "in radians, heading minus course",
            is_mirrored ? "--recording gnss.heading_unit=rad --recording gnss.heading=from_east"
                        : "--recording gnss.heading_unit=rad");
    }
  }
}

}  // namespace

const Check kGnssHeading{kHeadingCodes, look_at_headings};

}  // namespace traverse::plausibility
