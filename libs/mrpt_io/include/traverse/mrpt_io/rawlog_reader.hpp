#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <mrpt/serialization/CSerializable.h>

#include "traverse/mrpt_io/gz_stream.hpp"

namespace traverse::mrpt_io {

/// One object of a rawlog.
struct RawlogRecord {
  mrpt::serialization::CSerializable::Ptr object;
  std::string class_name;   ///< without namespace
  std::string place;        ///< "record 12, byte 3456"
  std::uint64_t begin = 0;  ///< the byte of the same, uncompressed
  std::size_t number = 0;   ///< and its number
};

/// Reads the objects of a rawlog one after the other. The format has no lengths: behind a record
/// that cannot be read, nothing can be.
class RawlogReader {
 public:
  /// \throws files::InputError if the file cannot be opened or does not begin like a rawlog.
  explicit RawlogReader(const std::filesystem::path& file);

  /// The next record; nothing at the end or where the file becomes unreadable.
  std::optional<RawlogRecord> next();

  /// Set after next() gave nothing, if that was not the end of a whole file.
  struct Fault {
    std::string reason;  ///< "the file is cut short: the rest is lost"
    std::string place;
  };
  const std::optional<Fault>& fault() const { return fault_; }

  /// Between two records.
  struct Position {
    std::uint64_t byte = 0;  ///< uncompressed
    std::size_t records = 0;
    std::optional<Fault> fault;
  };
  Position position() const { return {stream_.position(), records_, fault_}; }
  void return_to(const Position& position);

  std::uint64_t bytes_read() const { return stream_.position(); }
  std::size_t records_read() const { return records_; }
  double share_read() const { return stream_.share_read(); }

 private:
  std::string place() const;
  std::nullopt_t stop(const std::string& reason);

  GzInput stream_;
  std::size_t records_ = 0;
  std::uint64_t record_begin_ = 0;
  std::optional<Fault> fault_;
};

}  // namespace traverse::mrpt_io
