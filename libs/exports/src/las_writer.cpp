#include "traverse/exports/las_writer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <vector>

#include "traverse/files/atomic_file.hpp"

namespace traverse::exports {

namespace {

static_assert(std::endian::native == std::endian::little, "LAS is little-endian");

constexpr double kScale_m = 0.001;
constexpr std::size_t kHeaderBytes = 375;
constexpr std::size_t kRecordHeadBytes = 54;
constexpr std::size_t kPointBytes = 30;
constexpr std::size_t kBufferBytes = kPointBytes * 32768;

/// Values one after the other, as they lie in the file.
class Bytes {
 public:
  template <typename T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  void put_text(std::string_view text, std::size_t length) {  // with zeros behind it
    const std::size_t at = bytes_.size();
    bytes_.resize(at + length, 0);
    std::memcpy(bytes_.data() + at, text.data(), std::min(text.size(), length));
  }
  std::vector<char>& bytes() { return bytes_; }

 private:
  std::vector<char> bytes_;
};

void write(std::ostream& stream, const std::vector<char>& bytes) {
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

struct LasWriter::Content {
  Content(const std::filesystem::path& path, const LasDescription& of_all)
      : file(path), description(of_all) {
    buffer.bytes().reserve(kBufferBytes + kPointBytes);
  }

  Bytes header() const {
    Bytes h;
    h.put_text("LASF", 4);
    h.put(std::uint16_t{0});  // file source: points of several runs are told apart point by point
    constexpr std::uint16_t kIsWkt = 1U << 4U;
    h.put(static_cast<std::uint16_t>(kIsWkt | (description.is_gps_time ? 1U : 0U)));
    h.put_text("", 16);  // no project
    h.put(std::uint8_t{1});
    h.put(std::uint8_t{4});
    h.put_text("", 32);  // of what system is for the report to say
    h.put_text(description.generated_by, 32);
    h.put(static_cast<std::uint16_t>(description.day_of_year));
    h.put(static_cast<std::uint16_t>(description.year));
    h.put(static_cast<std::uint16_t>(kHeaderBytes));
    h.put(static_cast<std::uint32_t>(points_at()));
    h.put(std::uint32_t{1});  // records before the points: the coordinate system
    h.put(std::uint8_t{6});
    h.put(static_cast<std::uint16_t>(kPointBytes));
    h.put_text("", 24);  // numbers of 32 bits, of formats before 6
    for (int axis = 0; axis < 3; ++axis) h.put(kScale_m);
    for (int axis = 0; axis < 3; ++axis) h.put(description.offset_m[axis]);
    for (int axis = 0; axis < 3; ++axis) {
      h.put(count == 0 ? 0.0 : coordinate(highest[axis], axis));
      h.put(count == 0 ? 0.0 : coordinate(lowest[axis], axis));
    }
    h.put(std::uint64_t{0});  // no waveforms
    h.put(std::uint64_t{0});  // no records after the points
    h.put(std::uint32_t{0});
    h.put(count);
    h.put(count);  // all are first returns
    h.put_text("", 112);
    return h;
  }

  /// The coordinate system as a record: text that ends with a zero.
  Bytes projection() const {
    Bytes r;
    r.put(std::uint16_t{0});
    r.put_text("LASF_Projection", 16);
    r.put(std::uint16_t{2112});
    r.put(static_cast<std::uint16_t>(description.wkt.size() + 1));
    r.put_text("OGC coordinate system WKT", 32);
    r.put_text(description.wkt, description.wkt.size() + 1);
    return r;
  }

  std::size_t points_at() const {
    return kHeaderBytes + kRecordHeadBytes + description.wkt.size() + 1;
  }
  double coordinate(std::int32_t value, int axis) const {
    return value * kScale_m + description.offset_m[axis];
  }
  void flush() {
    write(file.stream(), buffer.bytes());
    buffer.bytes().clear();
  }

  files::AtomicFile file;
  LasDescription description;
  Bytes buffer;
  std::uint64_t count = 0;
  Eigen::Vector3i lowest = Eigen::Vector3i::Constant(std::numeric_limits<int>::max());
  Eigen::Vector3i highest = Eigen::Vector3i::Constant(std::numeric_limits<int>::min());
};

LasWriter::LasWriter(const std::filesystem::path& file, const LasDescription& description)
    : content_(std::make_unique<Content>(file, description)) {
  if (description.wkt.size() >= std::numeric_limits<std::uint16_t>::max()) {
    throw std::invalid_argument("a coordinate system of more than 64 KB");
  }
  // The header is written again when all points are known.
  write(content_->file.stream(), content_->header().bytes());
  write(content_->file.stream(), content_->projection().bytes());
}

LasWriter::LasWriter(LasWriter&&) noexcept = default;
LasWriter& LasWriter::operator=(LasWriter&&) noexcept = default;
LasWriter::~LasWriter() = default;

std::uint64_t LasWriter::size() const { return content_->count; }

void LasWriter::add(const LasPoint& point) {
  Content& c = *content_;
  Eigen::Vector3i place;
  for (int axis = 0; axis < 3; ++axis) {
    const double steps =
        std::round((point.position[axis] - c.description.offset_m[axis]) / kScale_m);
    if (!(std::abs(steps) <= std::numeric_limits<std::int32_t>::max())) {
      throw std::out_of_range("a point is no number, or more than 2147 km away from the others");
    }
    place[axis] = static_cast<std::int32_t>(steps);
  }
  c.lowest = c.lowest.cwiseMin(place);
  c.highest = c.highest.cwiseMax(place);
  constexpr std::uint8_t kFirstOfOne = 1U | (1U << 4U);
  for (int axis = 0; axis < 3; ++axis) c.buffer.put(static_cast<std::int32_t>(place[axis]));
  c.buffer.put(point.intensity);
  c.buffer.put(kFirstOfOne);
  c.buffer.put(std::uint8_t{0});  // flags, scanner's channel
  c.buffer.put(std::uint8_t{0});  // never classified
  c.buffer.put(point.user_data);
  c.buffer.put(std::int16_t{0});  // scan angle: rings are in the user data
  c.buffer.put(point.source);
  c.buffer.put(point.time_s);
  ++c.count;
  if (c.buffer.bytes().size() >= kBufferBytes) c.flush();
}

void LasWriter::commit() {
  content_->flush();
  content_->file.stream().seekp(0);
  write(content_->file.stream(), content_->header().bytes());
  content_->file.commit();
}

}  // namespace traverse::exports
