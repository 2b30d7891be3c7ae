#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace traverse::lidar {

/// Runs `work(begin, end)` for [0, count) cut into chunks of fixed size, so that what a chunk
/// computes does not depend on the number of threads. One thread runs them in order, without TBB.
template <typename Work>
void for_each_chunk(std::size_t count, std::size_t chunk, int threads, const Work& work) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  const auto run = [&](std::size_t c) { work(c * chunk, std::min(count, (c + 1) * chunk)); };
  if (threads <= 1 || chunks <= 1) {
    for (std::size_t c = 0; c < chunks; ++c) run(c);
    return;
  }
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, chunks, run); });
}

}  // namespace traverse::lidar
