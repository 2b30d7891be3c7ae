#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace traverse::fuzz {

/// A file without a place on disk that holds the fuzzer's bytes.
class InputInMemory {
 public:
  InputInMemory(const std::uint8_t* data, std::size_t size)
      : descriptor_(::memfd_create("input", 0)) {
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, data, size);
      if (written <= 0) break;
      data += written;
      size -= static_cast<std::size_t>(written);
    }
  }
  ~InputInMemory() { ::close(descriptor_); }
  InputInMemory(const InputInMemory&) = delete;
  InputInMemory& operator=(const InputInMemory&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace traverse::fuzz
