#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace traverse::bags {

/// A file that is read in pieces, wherever they stand.
class RandomAccessFile {
 public:
  /// \throws files::InputError if it cannot be opened
  explicit RandomAccessFile(const std::filesystem::path& file);
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Makes `bytes` what stands from `offset` on: `count` of them, fewer at the end of the file.
  /// \throws files::InputError if the disk does not give them
  void read(std::uint64_t offset, std::uint64_t count, std::vector<std::byte>& bytes) const;
  std::vector<std::byte> read(std::uint64_t offset, std::uint64_t count) const;

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// The first bytes of a file, fewer if it is shorter. \throws files::InputError
std::vector<std::byte> first_bytes(const std::filesystem::path& file, std::size_t count);

}  // namespace traverse::bags
