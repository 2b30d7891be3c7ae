#include "allocation_guard.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <mrpt/core/aligned_allocator.h>

#include "traverse/files/binary_file.hpp"

namespace traverse::mrpt_io {

namespace {

/// Smaller pieces are left alone: each needs bytes of the file before the next can be asked for.
constexpr std::size_t kLarge = std::size_t{4} << 20;
/// Memory that a byte of the file may take.
constexpr std::size_t kMostRatio = 4;

thread_local AllocationGuard* t_guard = nullptr;

}  // namespace

AllocationGuard::AllocationGuard(Holds holds)
    : holds_(std::move(holds)), outer_(std::exchange(t_guard, this)) {}

AllocationGuard::~AllocationGuard() { t_guard = outer_; }

AllocationGuard::Pause::Pause() : paused_(std::exchange(t_guard, nullptr)) {}
AllocationGuard::Pause::~Pause() { t_guard = paused_; }

bool AllocationGuard::allows(std::size_t bytes) noexcept {
  return bytes < kLarge || t_guard == nullptr || t_guard->check(bytes);
}

bool AllocationGuard::check(std::size_t bytes) noexcept {
  AllocationGuard* const here = std::exchange(t_guard, nullptr);  // what the check takes is its own
  bool allowed = false;
  try {
    allowed = bytes <= files::kMostBytesAtOnce && holds_((taken_ + bytes) / kMostRatio);
  } catch (...) {
    allowed = false;
  }
  t_guard = here;
  (allowed ? taken_ : refused_) += bytes;
  return allowed;
}

std::string AllocationGuard::refusal() const {
  if (refused_ == 0) return {};
  if (refused_ <= files::kMostBytesAtOnce) {
    return fmt::format("it states {} bytes, more than the file holds", refused_);
  }
  return fmt::format("it states {} bytes, of which at most {} are read in one piece", refused_,
                     files::kMostBytesAtOnce);
}

}  // namespace traverse::mrpt_io

// What MRPT makes its vectors with: a function of its own for coordinates and images, in whose
// place this one comes, and operator new for all others. What they return is freed as ever.

void* mrpt::aligned_malloc(std::size_t size, std::size_t alignment) {
  void* piece = nullptr;
  // MRPT's own gives null when there is no memory, and its vectors write there.
  if (!traverse::mrpt_io::AllocationGuard::allows(size) ||
      ::posix_memalign(&piece, std::max(alignment, sizeof(void*)), size) != 0) {
    throw std::bad_alloc();
  }
  return piece;
}

#ifndef TRAVERSE_SANITIZED

void* operator new(std::size_t size) {
  if (!traverse::mrpt_io::AllocationGuard::allows(size)) throw std::bad_alloc();
  for (;;) {
    if (void* piece = std::malloc(size == 0 ? 1 : size)) return piece;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void operator delete(void* piece) noexcept { std::free(piece); }
void operator delete(void* piece, std::size_t) noexcept { std::free(piece); }

#endif
