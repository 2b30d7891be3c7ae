#include "kitti/kitti_calibration.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;
using geometry::Pose3;

namespace {

/// Lines "key: number number ...", in some files without the colon.
class CalibrationTable {
 public:
  explicit CalibrationTable(std::filesystem::path file) : file_(std::move(file)) {
    constexpr std::size_t kMostKeys = 1000;
    constexpr std::size_t kMostWords = 100;  // more numbers than any key has, and itself
    files::LineReader reader(file_);
    while (reader.next()) {
      if (values_.size() == kMostKeys) {
        throw reader.error(fmt::format("a calibration of at most {} keys", kMostKeys), "more");
      }
      const std::vector<std::string_view> words = files::split_words(reader.line(), kMostWords);
      std::string_view key = words.front();
      if (key.ends_with(':')) key.remove_suffix(1);
      std::vector<double>& values = values_[std::string(key)];
      values.clear();
      for (std::size_t i = 1; i < words.size(); ++i) {
        const auto number = files::parse_double(words[i]);
        if (number && std::isfinite(*number)) values.push_back(*number);  // not so: a date
      }
    }
  }

  bool has(const std::string& key) const { return values_.contains(key); }

  Pose3 pose(const std::string& key) const {
    const std::vector<double>& v = take(key, 12);
    Pose3 pose;
    pose.rotation << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
    pose.translation << v[3], v[7], v[11];
    return checked(pose, key);
  }

  Pose3 rotation(const std::string& key) const {
    const std::vector<double>& v = take(key, 9);
    Pose3 pose;
    pose.rotation << v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8];
    return checked(pose, key);
  }

  Eigen::Vector3d vector(const std::string& key) const {
    const std::vector<double>& v = take(key, 3);
    return {v[0], v[1], v[2]};
  }

  InputError missing(const std::string& keys) const {
    return {file_, Place::whole_file(), keys, "none of them"};
  }

 private:
  const std::vector<double>& take(const std::string& key, std::size_t count) const {
    const auto found = values_.find(key);
    if (found == values_.end() || found->second.size() != count) {
      throw InputError(file_, Place::key(key), fmt::format("{} numbers", count),
                       found == values_.end() ? "none" : fmt::format("{}", found->second.size()));
    }
    return found->second;
  }

  Pose3 checked(const Pose3& pose, const std::string& key) const {
    const double deviation =
        (pose.rotation * pose.rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
    if (!(deviation < 1e-3) || pose.rotation.determinant() < 0) {
      throw InputError(file_, Place::key(key), "a rotation matrix", "another matrix");
    }
    return pose.orthonormalised();
  }

  std::filesystem::path file_;
  std::map<std::string, std::vector<double>> values_;
};

std::optional<std::string> first_present(const CalibrationTable& table,
                                         std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (table.has(key)) return key;
  }
  return std::nullopt;
}

}  // namespace

CameraCalibration read_camera_calibration(const std::filesystem::path& file) {
  const CalibrationTable table(file);
  if (table.has("Tr")) return {table.pose("Tr"), "Tr"};
  const auto tr = first_present(table, {"Tr_velo_to_cam", "Tr_velo_cam"});
  if (!tr) throw table.missing("Tr, Tr_velo_to_cam or Tr_velo_cam");
  const auto rectification = first_present(table, {"R0_rect", "R_rect"});
  if (!rectification) return {table.pose(*tr), *tr};
  return {table.rotation(*rectification) * table.pose(*tr), *rectification + " " + *tr};
}

Pose3 read_raw_calibration(const std::filesystem::path& file) {
  const CalibrationTable table(file);
  Pose3 pose = table.rotation("R");
  pose.translation = table.vector("T");
  return pose;
}

Pose3 read_raw_camera_calibration(const std::filesystem::path& velo_to_cam,
                                  const std::filesystem::path& cam_to_cam) {
  return CalibrationTable(cam_to_cam).rotation("R_rect_00") * read_raw_calibration(velo_to_cam);
}

}  // namespace traverse::dataset
