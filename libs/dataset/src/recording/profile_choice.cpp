#include "recording/profile_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/input_error.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;
using sensors::LidarProfile;

std::vector<std::string> installed_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string ring_text(const LidarProfile& profile) {
  std::string expected =
      profile.rings > 0 ? fmt::format("{} expected", profile.rings) : "number unknown";
  switch (profile.ring_source) {
    case sensors::RingSource::kData:
      return "stored with the points, " + expected;
    case sensors::RingSource::kStorageOrder:
      return "from the storage order, a ring ends where the azimuth wraps, " + expected;
    case sensors::RingSource::kElevation:
      return "from the elevation angle, " + expected;
  }
  return expected;
}

std::string time_text(const LidarProfile& profile) {
  switch (profile.time_source) {
    case sensors::TimeSource::kData:
      return "stored with the points";
    case sensors::TimeSource::kAzimuth:
      return fmt::format(
          "from the azimuth: {} s a revolution, {}, from {} deg; the stamp is at {:g} of it",
          profile.sweep_s,
          profile.rotation == sensors::Rotation::kClockwise ? "clockwise" : "counterclockwise",
          profile.seam_azimuth_deg, profile.stamp_fraction);
    case sensors::TimeSource::kNone:
      return "unknown";
  }
  return "unknown";
}

/// Where the first of `keys` that is stated stands.
std::string reason_for(std::initializer_list<std::string_view> keys, const Statements& statements,
                       const std::string& otherwise) {
  for (const std::string_view key : keys) {
    if (const auto origin = statements.origin(key)) return *origin;
  }
  return otherwise;
}

}  // namespace

ProfileChoice installed_profile(const fs::path& share_folder, const std::string& name) {
  const fs::path folder = share_folder / "sensors";
  const fs::path file = folder / (name + ".yaml");
  if (!fs::exists(file)) {
    throw files::InputError(
        folder, files::Place::whole_file(),
        fmt::format("a sensor profile ({})", fmt::join(installed_names(folder), ", ")),
        files::in_quotes(name));
  }
  return {sensors::load_lidar_profile(file), "profile " + name};
}

ProfileChoice choose_profile(const Statements& statements, const fs::path& share_folder,
                             ProfileChoice otherwise) {
  ProfileChoice choice = std::move(otherwise);
  if (statements.states("sensor")) {
    const bool is_name =
        statements->sensor.find('/') == std::string::npos && !statements->sensor.ends_with(".yaml");
    choice = is_name ? installed_profile(share_folder, statements->sensor)
                     : ProfileChoice{sensors::load_lidar_profile(
                                         statements.find_file("sensor", statements->sensor)),
                                     "profile " + statements->sensor};
    choice.reason += ", stated in " + *statements.origin("sensor");
  }
  statements.override_profile(choice.profile);
  return choice;
}

void add_profile_facts(const ProfileChoice& choice, const Statements& statements,
                       const std::string& prefix, std::vector<Fact>& facts) {
  const LidarProfile& profile = choice.profile;
  const auto add = [&](const char* name, std::string value,
                       std::initializer_list<std::string_view> keys) {
    facts.push_back({prefix + name, std::move(value), reason_for(keys, statements, choice.reason)});
  };
  add("lidar", profile.name, {"lidar.name"});
  add("rings", ring_text(profile), {"lidar.ring_source", "lidar.rings"});
  add("point times", time_text(profile),
      {"lidar.time_source", "lidar.sweep_s", "lidar.rotation", "lidar.seam_azimuth_deg",
       "lidar.stamp_fraction"});
  add("range used", fmt::format("{:g} to {:g} m", profile.min_range_m, profile.max_range_m),
      {"lidar.min_range_m", "lidar.max_range_m"});
  add("vertical correction",
      profile.vertical_correction_deg == 0 ? "none"
                                           : fmt::format("{:+g} deg, applied when the scan is used",
                                                         profile.vertical_correction_deg),
      {"lidar.vertical_correction_deg"});
  add("round poles",
      profile.pole_depth == 0
          ? "the mean of the returns is taken for the axis"
          : fmt::format("the axis lies {:.3g} radii behind the mean of the returns",
                        profile.pole_depth),
      {"lidar.pole_depth"});
}

}  // namespace traverse::dataset
