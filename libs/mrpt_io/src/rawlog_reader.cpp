#include "traverse/mrpt_io/rawlog_reader.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"

#include "allocation_guard.hpp"
#include "later_records.hpp"

namespace traverse::mrpt_io {

namespace {

constexpr std::uint32_t kMostCounted = 1 << 24;  // points of a scan

/// The classes that make up the bulk of a recording have no four-byte numbers but counts.
bool holds_only_counts(const std::string& class_name) {
  return class_name == "CObservationVelodyneScan" || class_name == "CObservationIMU";
}

/// The class at the head of a record: a byte with the length of the name and bit 7 set, the name;
/// before MRPT 0.5.5 a 32-bit length instead. Nothing if that is not what stands there.
std::optional<std::string> class_at_head(GzInput& stream) {
  constexpr std::size_t kLongestName = 120;  // MRPT's own limit
  const std::string_view head = stream.peek(4 + kLongestName);
  if (head.empty()) return std::nullopt;
  const auto first = static_cast<unsigned char>(head.front());
  const std::size_t length = first & 0x7FU;
  const bool old_form = (first & 0x80U) == 0;
  const std::size_t begin = old_form ? 4 : 1;
  if (old_form && head.substr(1, 3) != std::string_view("\0\0\0", 3)) return std::nullopt;
  if (length == 0 || length > kLongestName || head.size() < begin + length) return std::nullopt;
  const std::string_view name = head.substr(begin, length);
  const bool is_name = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == ':';
  });
  return is_name ? std::optional(std::string(name)) : std::nullopt;
}

std::string without_namespace(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string::npos ? name : name.substr(colon + 1);
}

}  // namespace

RawlogReader::RawlogReader(const std::filesystem::path& file) : stream_(file) {
  read_later_records();
  const std::string_view start = stream_.peek(16);
  const auto class_name = class_at_head(stream_);
  if (!start.empty() && class_name) return;
  throw files::InputError(file, files::Place::whole_file(),
                          "an MRPT rawlog, which begins with the name of a class",
                          !stream_.fault().empty() ? stream_.fault()
                          : start.empty()          ? "an empty file"
                                                   : files::in_quotes(stream_.peek(16)));
}

std::string RawlogReader::place() const {
  return fmt::format("record {}, byte {}", records_, record_begin_);
}

std::nullopt_t RawlogReader::stop(const std::string& reason) {
  fault_ = Fault{reason + ": the rest of the file is not read", place()};
  return std::nullopt;
}

void RawlogReader::return_to(const Position& position) {
  stream_.go_to(position.byte);
  records_ = position.records;
  fault_ = position.fault;
}

std::optional<RawlogRecord> RawlogReader::next() {
  if (fault_) return std::nullopt;
  record_begin_ = stream_.position();
  if (stream_.peek(1).empty()) {
    if (stream_.fault().empty()) return std::nullopt;
    return stop(stream_.fault());
  }
  const auto class_name = class_at_head(stream_);
  if (!class_name) {
    // A name that the end of the file cuts is a cut, anything else is not a record.
    return stop(stream_.peek(124).size() < 124 ? "the file is cut short"
                                               : "what follows is not a record");
  }
  const std::string short_name = without_namespace(*class_name);
  if (mrpt::rtti::findRegisteredClass(*class_name) == nullptr) {
    return stop(fmt::format("a record of the class {}, which MRPT does not know here", short_name));
  }
  AllocationGuard guard(
      [this](std::uint64_t bytes) { return stream_.reaches(record_begin_ + bytes); });
  try {
    stream_.expect_counts_up_to(holds_only_counts(short_name) ? std::optional(kMostCounted)
                                                              : std::nullopt);
    auto archive = mrpt::serialization::archiveFrom(stream_);
    RawlogRecord record{archive.ReadObject(), short_name, place(), record_begin_, records_};
    ++records_;
    return record;
  } catch (const std::exception&) {
    if (const std::string refusal = guard.refusal(); !refusal.empty()) {
      return stop(fmt::format("a record of the class {} is damaged: {}", short_name, refusal));
    }
    // MRPT's own message is "EOF" whatever happened; the stream knows whether the bytes ran out.
    return stop(
        !stream_.fault().empty()
            ? stream_.fault()
            : fmt::format("a record of the class {} is damaged or of a later version", short_name));
  }
}

}  // namespace traverse::mrpt_io
