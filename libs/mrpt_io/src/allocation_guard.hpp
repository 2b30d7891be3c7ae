#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace traverse::mrpt_io {

/// While it lives, this thread takes large pieces of memory only for what is there to be read.
///
/// MRPT makes a vector as long as a record states before it looks for the bytes to fill it with, so
/// that a damaged or made-up record of a hundred bytes takes gigabytes. Nothing but the allocation
/// stands between the two, so that is where it is stopped: with std::bad_alloc, which MRPT passes
/// on. In the sanitizers' builds, whose operator new is their own, for coordinates and images only.
class AllocationGuard {
 public:
  /// Whether what is read holds so many bytes, from where it stood when the guard came.
  using Holds = std::function<bool(std::uint64_t bytes)>;

  explicit AllocationGuard(Holds holds);
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// While it lives, there is no guard: for what is done with what was read.
  class Pause {
   public:
    Pause();
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    AllocationGuard* paused_;
  };

  /// Of the calling thread; for the allocation functions.
  static bool allows(std::size_t bytes) noexcept;

  /// "it states 4294967296 bytes, more than the file holds"; empty as long as nothing was refused.
  std::string refusal() const;

 private:
  bool check(std::size_t bytes) noexcept;

  Holds holds_;
  AllocationGuard* outer_;
  std::uint64_t taken_ = 0;  ///< in large pieces
  std::size_t refused_ = 0;
};

}  // namespace traverse::mrpt_io
