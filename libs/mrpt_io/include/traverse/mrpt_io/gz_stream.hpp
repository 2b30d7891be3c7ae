#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;

namespace traverse::mrpt_io {

/// A file that may be gzip-compressed, read forward. MRPT's archives read from it; where MRPT's own
/// stream gives fewer bytes than asked for and goes on with garbage, this one throws.
///
/// Bytes are given out only when a stretch behind them could be decompressed too: most damage in
/// compressed data shows a little later than it begins, and the garbage between would be taken for
/// the lengths of arrays.
class GzInput {
 public:
  /// \throws files::InputError if it cannot be opened.
  explicit GzInput(std::filesystem::path path);

  /// The next bytes without taking them, `count` at most 1 kB; fewer only near the end.
  std::string_view peek(std::size_t count);

  std::uint64_t position() const { return position_; }  ///< bytes taken, uncompressed
  /// Goes on reading from there. Cheap in a file that is not compressed; in a compressed one all
  /// that lies before is decompressed, on the way back from the beginning.
  void go_to(std::uint64_t position);
  double share_read() const;  ///< of the file on disk, 0 to 1
  /// Whether the bytes before `end` (uncompressed) are there. Found out by decompressing them, if
  /// need be.
  bool reaches(std::uint64_t end);
  /// What stopped a read: "the file is cut short", or what zlib says; empty as long as all is well.
  const std::string& fault() const { return fault_; }

  /// While set, every read of four bytes is that of a count (or of the things counted, right
  /// behind it), and a count above `most` is damage: MRPT would take memory for as many things
  /// before it looks whether they are there.
  void expect_counts_up_to(std::optional<std::uint32_t> most) {
    max_counted_ = most;
    things_follow_ = false;
  }

  /// The interface that mrpt::serialization::archiveFrom() expects; Read() gives all or throws.
  std::size_t Read(void* to, std::size_t count);
  std::size_t Write(const void* from, std::size_t count);
  std::string getStreamDescription() const { return path_.string(); }

 private:
  void read_ahead();
  void check_count(const void* bytes, std::size_t count);
  std::string_view ahead() const;

  std::filesystem::path path_;
  std::uintmax_t file_size_;
  std::unique_ptr<gzFile_s, void (*)(gzFile_s*)> file_;
  std::vector<char> buffer_;  ///< decompressed; [begin_, end_) is not given out yet
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool at_end_ = false;  ///< of what can be decompressed
  std::uint64_t position_ = 0;
  std::optional<std::uint32_t> max_counted_;
  bool things_follow_ = false;  ///< the last count was of things that may be four bytes together
  std::string fault_;

  std::unique_ptr<gzFile_s, void (*)(gzFile_s*)> ahead_file_;  ///< of reaches(); or null
  std::uint64_t known_until_ = 0;  ///< bytes that are known to be there, uncompressed
};

/// A file written with gzip compression, or plain with level 0.
class GzOutput {
 public:
  /// Overwrites `path`; `level` 0 to 9. \throws files::OutputError
  GzOutput(std::filesystem::path path, int level);

  /// Writes what is still buffered. \throws files::OutputError if a byte was not taken, now or
  /// before.
  void close();

  /// The interface that mrpt::serialization::archiveFrom() expects.
  std::size_t Write(const void* from, std::size_t count);
  std::size_t Read(void* to, std::size_t count);
  std::string getStreamDescription() const { return path_.string(); }

  const std::string& fault() const { return fault_; }

 private:
  std::filesystem::path path_;
  std::unique_ptr<gzFile_s, void (*)(gzFile_s*)> file_;
  std::string fault_;
};

}  // namespace traverse::mrpt_io
