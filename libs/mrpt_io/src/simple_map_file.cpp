#include "traverse/mrpt_io/simple_map_file.hpp"

#include <cmath>
#include <cstdint>
#include <exception>
#include <string>

#include <fmt/format.h>
#include <mrpt/maps/CSimpleMap.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/gz_stream.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"

#include "allocation_guard.hpp"
#include "later_records.hpp"

namespace traverse::mrpt_io {

namespace {

constexpr int kCompression = 1;  // as MRPT's
constexpr std::uint8_t kPosesOfSpace = 1;
constexpr std::uint8_t kWithTwists = 2;  // since MRPT 2.15.0
constexpr double kFarthest_m = 1e9;      // from the origin of the map: nothing drives there
constexpr float kSight_m = 1e5;

// To MRPT's archives both classes are the map they are derived from: they add no run-time type and
// only say otherwise what stands between a map's head and its end.

class WrittenOneByOne final : public mrpt::maps::CSimpleMap {
 public:
  WrittenOneByOne(std::size_t keyframes,
                  const std::function<void(mrpt::serialization::CArchive&, std::size_t)>& write)
      : keyframes_(keyframes), write_(write) {}

 protected:
  std::uint8_t serializeGetVersion() const override { return kPosesOfSpace; }
  void serializeTo(mrpt::serialization::CArchive& archive) const override {
    archive << static_cast<std::uint32_t>(keyframes_);
    for (std::size_t i = 0; i < keyframes_; ++i) write_(archive, i);
  }

 private:
  std::size_t keyframes_;
  const std::function<void(mrpt::serialization::CArchive&, std::size_t)>& write_;
};

/// A std::optional of a velocity: its own name, that of the type, whether there is one, six
/// numbers.
void pass_twist(mrpt::serialization::CArchive& archive) {
  std::string name;
  std::string type;
  archive >> name >> type;
  if (name != "std::optional") throw std::runtime_error("no velocity behind a keyframe");
  bool has_value = false;
  archive >> has_value;
  for (int i = 0; has_value && i < 6; ++i) archive.ReadAs<double>();
}

class TakenOneByOne final : public mrpt::maps::CSimpleMap {
 public:
  using Take = std::function<void(std::size_t, const mrpt::poses::CPose3DPDF&,
                                  const mrpt::obs::CSensoryFrame&)>;
  explicit TakenOneByOne(const Take& take) : take_(take) {}

  std::size_t taken() const { return taken_; }
  /// What `take` threw; MRPT would throw something else instead.
  const std::exception_ptr& error() const { return error_; }

 protected:
  void serializeFrom(mrpt::serialization::CArchive& archive, std::uint8_t version) override {
    if (version != kPosesOfSpace && version != kWithTwists) {  // of the plane, or yet later
      CSimpleMap::serializeFrom(archive, version);
      for (const Pair& pair : *this) take(*pair.pose, *pair.sf);
      return;
    }
    const auto keyframes = archive.ReadAs<std::uint32_t>();
    for (std::uint32_t i = 0; i < keyframes; ++i) {
      const auto pose = archive.ReadObject<mrpt::poses::CPose3DPDF>();
      const auto frame = archive.ReadObject<mrpt::obs::CSensoryFrame>();
      if (version == kWithTwists) pass_twist(archive);
      if (!pose || !frame) throw std::runtime_error("a keyframe without pose or scan");
      take(*pose, *frame);
    }
  }

 private:
  void take(const mrpt::poses::CPose3DPDF& pose, const mrpt::obs::CSensoryFrame& frame) {
    const AllocationGuard::Pause pause;
    try {
      take_(taken_++, pose, frame);
    } catch (...) {
      error_ = std::current_exception();
      throw;
    }
  }

  const Take& take_;
  std::size_t taken_ = 0;
  std::exception_ptr error_;
};

void require_place(const std::filesystem::path& file, std::size_t record,
                   const mrpt::poses::CPose3DPDF& pose) {
  const geometry::Pose3 T = to_pose(pose.getMeanVal());
  if (T.translation.cwiseAbs().maxCoeff() <= kFarthest_m && T.rotation.allFinite()) return;
  throw files::InputError(file, files::Place::record(record),
                          fmt::format("a pose within {:.0e} m", kFarthest_m),
                          "one farther off, or no numbers");
}

}  // namespace

void write_simple_map(
    const std::filesystem::path& file, std::size_t keyframes,
    const std::function<void(mrpt::serialization::CArchive& archive, std::size_t i)>& write) {
  files::AtomicFile target(file);
  GzOutput stream(target.temporary_path(), kCompression);
  try {
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive << WrittenOneByOne(keyframes, write);
    stream.close();
  } catch (const std::exception& error) {
    throw files::OutputError(file, stream.fault().empty() ? message_of(error) : stream.fault());
  }
  target.commit();
}

std::size_t for_each_keyframe(
    const std::filesystem::path& file,
    const std::function<void(std::size_t i, const mrpt::poses::CPose3DPDF& pose,
                             const mrpt::obs::CSensoryFrame& frame)>& take) {
  read_later_records();
  GzInput stream(file);
  const TakenOneByOne::Take take_checked = [&](std::size_t i, const auto& pose, const auto& frame) {
    require_place(file, i, pose);
    take(i, pose, frame);
  };
  TakenOneByOne map(take_checked);
  AllocationGuard guard([&](std::uint64_t bytes) { return stream.reaches(bytes); });
  try {
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive.ReadObject(&map);
  } catch (const std::exception& error) {
    if (map.error()) std::rethrow_exception(map.error());
    if (const std::string refusal = guard.refusal(); !refusal.empty()) {
      throw files::InputError(file, files::Place::whole_file(), "a simple map of MRPT",
                              "a damaged one: " + refusal);
    }
    throw files::InputError(file, files::Place::whole_file(), "a simple map of MRPT",
                            stream.fault().empty() ? message_of(error) : stream.fault());
  }
  return map.taken();
}

void require_points_in_sight(const std::filesystem::path& file, std::size_t record,
                             std::span<const float> x, std::span<const float> y,
                             std::span<const float> z) {
  for (const auto& axis : {x, y, z}) {
    for (const float value : axis) {
      if (std::abs(value) <= kSight_m) continue;
      throw files::InputError(file, files::Place::record(record),
                              fmt::format("points within {:.0f} km", kSight_m / 1000),
                              fmt::format("{} m", value));
    }
  }
}

}  // namespace traverse::mrpt_io
