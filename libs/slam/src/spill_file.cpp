#include "spill_file.hpp"

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "traverse/slam/keyframe_store.hpp"

namespace traverse::slam {

namespace {

/// Writes the fields of a keyframe or, the same fields in the same order, reads them. The bytes are
/// those of memory: no other program and no later run reads them.
/// \tparam Transfer takes a pointer to bytes, constant ones to write from, and their number
template <typename Transfer>
struct Fields {
  Transfer transfer;

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
    value(k.health.registered), value(k.health.converged), value(k.health.reason);
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
    transfer(data, count);
  }
};

}  // namespace

SpillFile::SpillFile(const std::filesystem::path& folder) : file_(folder) {}

std::uint64_t SpillFile::append(const Keyframe& keyframe) {
  std::vector<std::byte> whole;
  whole.reserve(bytes_of(keyframe));
  const auto write = [&](const void* data, std::size_t count) {
    const auto* bytes = static_cast<const std::byte*>(data);
    whole.insert(whole.end(), bytes, bytes + count);
  };
  Fields<decltype(write)>{write}.keyframe(keyframe);
  const parallel::Lock lock(mutex_);
  return file_.append(whole);
}

Keyframe SpillFile::read(std::uint64_t offset) {
  const parallel::Lock lock(mutex_);
  const files::ScratchFile* const file = &file_;
  Keyframe keyframe;
  const auto read = [&](void* data, std::size_t count) {
    file->read(offset, {static_cast<std::byte*>(data), count});
    offset += count;
  };
  Fields<decltype(read)>{read}.keyframe(keyframe);
  return keyframe;
}

}  // namespace traverse::slam
