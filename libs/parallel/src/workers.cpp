#include "traverse/parallel/workers.hpp"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace traverse::parallel {

struct Workers::Arena {
  explicit Arena(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

Workers::Workers(int threads) : arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr) {}

Workers::~Workers() = default;

void Workers::run_in_arena(std::size_t count, const void* task,
                           void (*call)(const void* task, std::size_t k)) {
  arena_->arena.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, count, [&](std::size_t k) { call(task, k); }, tbb::simple_partitioner());
  });
}

}  // namespace traverse::parallel
