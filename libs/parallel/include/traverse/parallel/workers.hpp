#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

namespace traverse::parallel {

/// A fixed number of threads. Work comes as numbered tasks whose cut does not depend on the number
/// of threads; whoever reduces their results does so in the order of the tasks, so that the result
/// is the same bits for any number of them.
class Workers {
 public:
  /// \param threads 1 or less: tasks run in the caller, one after the other
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// task(0) ... task(count - 1), in order without threads.
  template <typename Task>
  void run(std::size_t count, const Task& task) {
    if (arena_ == nullptr || count <= 1) {
      for (std::size_t k = 0; k < count; ++k) task(k);
      return;
    }
    run_in_arena(count, &task,
                 [](const void* any, std::size_t k) { (*static_cast<const Task*>(any))(k); });
  }

  /// work(begin, end) for [0, count) in chunks of fixed size.
  template <typename Work>
  void run_chunks(std::size_t count, std::size_t chunk, const Work& work) {
    run((count + chunk - 1) / chunk,
        [&](std::size_t c) { work(c * chunk, std::min(count, (c + 1) * chunk)); });
  }

 private:
  struct Arena;  // TBB's, which stays behind the source

  void run_in_arena(std::size_t count, const void* task,
                    void (*call)(const void* task, std::size_t k));

  std::unique_ptr<Arena> arena_;
};

}  // namespace traverse::parallel
