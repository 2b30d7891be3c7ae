#pragma once

#include <condition_variable>
#include <mutex>

/// Clang's thread-safety annotations: the sanitizers' builds refuse a source that touches what a
/// mutex guards without holding it. GCC knows none of them.
#if defined(__clang__)
#define TRAVERSE_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define TRAVERSE_THREAD_ATTRIBUTE(x)
#endif
/// Of a member: only to be touched while the mutex is held.
#define TRAVERSE_GUARDED_BY(mutex) TRAVERSE_THREAD_ATTRIBUTE(guarded_by(mutex))
/// Of a function: only to be called while the mutex is held.
#define TRAVERSE_REQUIRES(mutex) TRAVERSE_THREAD_ATTRIBUTE(requires_capability(mutex))

namespace traverse::parallel {

/// std::mutex with the annotations that libstdc++'s lacks.
class TRAVERSE_THREAD_ATTRIBUTE(capability("mutex")) Mutex {
 public:
  void lock() TRAVERSE_THREAD_ATTRIBUTE(acquire_capability()) { mutex_.lock(); }
  void unlock() TRAVERSE_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }
  bool try_lock() TRAVERSE_THREAD_ATTRIBUTE(try_acquire_capability(true)) {
    return mutex_.try_lock();
  }

 private:
  std::mutex mutex_;
};

/// Says that the mutex is held already, for a Lock that is to release it.
struct Adopt {};

/// Holds a mutex as long as it lives.
class TRAVERSE_THREAD_ATTRIBUTE(scoped_lockable) Lock {
 public:
  explicit Lock(Mutex& mutex) TRAVERSE_THREAD_ATTRIBUTE(acquire_capability(mutex)) : mutex_(mutex) {
    mutex_.lock();
  }
  Lock(Mutex& mutex, Adopt) TRAVERSE_REQUIRES(mutex) : mutex_(mutex) {}
  ~Lock() TRAVERSE_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  Mutex& mutex_;
};

/// What threads wait on with the mutex held: `changed.wait_for(mutex_, time)`.
using Condition = std::condition_variable_any;

}  // namespace traverse::parallel
