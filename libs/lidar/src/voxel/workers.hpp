#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace traverse::lidar::voxel {

/// The threads of one odometry. Work comes as numbered tasks whose cut does not depend on the
/// number of threads; whoever reduces their results does so in the order of the tasks.
class Workers {
 public:
  explicit Workers(int threads)
      : arena_(threads > 1 ? std::make_unique<tbb::task_arena>(threads) : nullptr) {}

  /// task(0) ... task(count - 1), in order without threads.
  template <typename Task>
  void run(std::size_t count, const Task& task) {
    if (arena_ == nullptr || count <= 1) {
      for (std::size_t k = 0; k < count; ++k) task(k);
      return;
    }
    arena_->execute(
        [&] { tbb::parallel_for(std::size_t{0}, count, task, tbb::simple_partitioner()); });
  }

  /// work(begin, end) for [0, count) in chunks of fixed size.
  template <typename Work>
  void run_chunks(std::size_t count, std::size_t chunk, const Work& work) {
    run((count + chunk - 1) / chunk,
        [&](std::size_t c) { work(c * chunk, std::min(count, (c + 1) * chunk)); });
  }

 private:
  std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace traverse::lidar::voxel
