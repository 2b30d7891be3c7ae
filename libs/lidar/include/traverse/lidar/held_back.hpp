#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace traverse::lidar {

/// The start of a recording: scans are held back until there are enough of them to find the initial
/// speed from; from then on each passes.
template <typename Scan>
class HeldBack {
 public:
  /// \param scans to wait for; below 2 none is held back
  explicit HeldBack(int scans) : enough_(static_cast<std::size_t>(std::max(1, scans))) {}

  /// \returns the scans that go on now, in order: none, all that waited, or this one
  std::vector<Scan> add(Scan scan) {
    waiting_.push_back(std::move(scan));
    return waiting_.size() >= enough_ ? release() : std::vector<Scan>{};
  }

  /// The scans that wait still: the recording ends, or there are enough.
  std::vector<Scan> release() {
    if (!waiting_.empty()) enough_ = 1;
    return std::exchange(waiting_, {});
  }

 private:
  std::size_t enough_;
  std::vector<Scan> waiting_;
};

}  // namespace traverse::lidar
