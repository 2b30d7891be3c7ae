#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace traverse::files {

/// Room on disk for bytes that are needed until the program is through with them. The file has no
/// name, so that nothing of it is left however the program ends.
class ScratchFile {
 public:
  /// \throws OutputError if the folder does not exist or does not allow a file.
  explicit ScratchFile(const std::filesystem::path& folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// \returns where the bytes begin, for read(). \throws OutputError (disk full)
  std::uint64_t append(std::span<const std::byte> bytes);

  /// Fills `bytes` with what was appended from `offset` on.
  /// \throws OutputError if there is not so much.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path folder_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

}  // namespace traverse::files
