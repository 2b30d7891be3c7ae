#include "spill_file.hpp"

#include <cstdlib>
#include <string>
#include <type_traits>
#include <unistd.h>
#include <vector>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::slam {

namespace {

/// Writes the fields of a keyframe to a stream or, the same fields in the same order, reads them.
/// The bytes are those of memory: no other program and no later run reads them.
template <typename Stream>
struct Fields {
  Stream& stream;

  template <typename Value>
  void value(Value& x) {
    static_assert(std::is_trivially_copyable_v<std::remove_const_t<Value>>);
    bytes(&x, sizeof(Value));
  }
  template <typename Vector>
  void values(Vector& x) {
    std::uint64_t size = x.size();
    value(size);
    if constexpr (!std::is_const_v<Vector>) x.resize(size);
    bytes(x.data(), size * sizeof(*x.data()));
  }
  template <typename Points>
  void sweep(Points& p) {
    values(p.x), values(p.y), values(p.z), values(p.range), values(p.time), values(p.source);
  }
  template <typename AnyKeyframe>
  void keyframe(AnyKeyframe& k) {
    value(k.id), value(k.stamp);
    doubles(k.T_odom_lidar.rotation), doubles(k.T_odom_lidar.translation);
    values(k.points.x), values(k.points.y), values(k.points.z);
    values(k.points.intensity), values(k.points.time), values(k.points.ring);
    value(k.features.stamp), value(k.features.points), value(k.features.dropped);
    value(k.features.from_range_image), value(k.features.timed);
    sweep(k.features.surface), values(k.features.surface_is_planar);
    sweep(k.features.planar), sweep(k.features.edges);
    value(k.features.organise_ms), value(k.features.features_ms);
    doubles(k.step_covariance);
    value(k.health.line_matches), value(k.health.plane_matches), value(k.health.residual_rms_m);
    value(k.health.inlier_share), value(k.health.steps), value(k.health.iterations);
    value(k.health.registered);
    doubles(k.health.observability.eigenvalues), doubles(k.health.observability.directions);
    value(k.health.observability.rotation_scale_m), value(k.health.observability.degenerate);
  }

 private:
  template <typename Matrix>
  void doubles(Matrix& m) {
    bytes(m.data(), static_cast<std::size_t>(m.size()) * sizeof(double));
  }
  template <typename Data>
  void bytes(Data* data, std::size_t count) {
    const auto size = static_cast<std::streamsize>(count);
    if constexpr (std::is_same_v<Stream, std::ostream>) {
      stream.write(reinterpret_cast<const char*>(data), size);
    } else {
      stream.read(reinterpret_cast<char*>(data), size);
    }
  }
};

}  // namespace

SpillFile::SpillFile() {
  std::string name =
      (std::filesystem::temp_directory_path() / "traverse-keyframes-XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  path_ = name;
  if (descriptor < 0) throw files::OutputError(path_, "cannot be made for keyframes");
  close(descriptor);
  stream_.open(path_, std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
  // The file has no name from here on: it goes when the process does, however that ends.
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

SpillFile::~SpillFile() = default;

std::uint64_t SpillFile::append(const Keyframe& keyframe) {
  const std::lock_guard lock(mutex_);
  stream_.clear();
  stream_.seekp(0, std::ios::end);
  const auto offset = static_cast<std::uint64_t>(stream_.tellp());
  Fields<std::ostream>{stream_}.keyframe(keyframe);
  stream_.flush();
  if (!stream_) {
    throw files::OutputError(path_, "keyframes cannot be spilled (is the disk full?)");
  }
  return offset;
}

Keyframe SpillFile::read(std::uint64_t offset) {
  const std::lock_guard lock(mutex_);
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(offset));
  Keyframe keyframe;
  Fields<std::istream>{stream_}.keyframe(keyframe);
  if (!stream_) {
    throw files::InputError(path_, files::Place::whole_file(), "a spilled keyframe", "its end");
  }
  return keyframe;
}

}  // namespace traverse::slam
