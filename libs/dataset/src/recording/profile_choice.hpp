#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/sensors/lidar_profile.hpp"

#include "recording/statements.hpp"

namespace traverse::dataset {

/// A lidar profile and where it comes from.
struct ProfileChoice {
  sensors::LidarProfile profile;
  std::string reason;  ///< "profile hdl64e_kitti, stated in traverse.yaml, line 2"
};

/// The profile `name` of share_folder/sensors. \throws files::InputError listing those there are.
ProfileChoice installed_profile(const std::filesystem::path& share_folder, const std::string& name);

/// The profile that the statements name, or else `otherwise`, with the keys under `lidar` over it.
/// \throws files::InputError
ProfileChoice choose_profile(const Statements& statements,
                             const std::filesystem::path& share_folder, ProfileChoice otherwise);

/// Lists what the profile makes of a scan: rings, point times, vertical correction. `prefix` tells
/// one lidar's facts from another's: "left: ".
void add_profile_facts(const ProfileChoice& choice, const Statements& statements,
                       const std::string& prefix, std::vector<Fact>& facts);

}  // namespace traverse::dataset
