#include "traverse/dataset/ply_blocks.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

#include "point_clouds/field_values.hpp"
#include "point_clouds/ply_header.hpp"
#include "recording/file_cursor.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

namespace {

constexpr std::size_t kBlockPoints = std::size_t{1} << 16;
constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 20;

/// As many as there are, `count` at most.
std::vector<std::byte> take_bytes(std::ifstream& stream, std::size_t count) {
  std::vector<std::byte> bytes(count);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace

struct PlyBlocks::Content {
  std::filesystem::path path;
  std::ifstream stream;
  PlyElement vertex;
  bool swap_bytes = false;
  std::size_t done = 0;
};

PlyBlocks::PlyBlocks(const std::filesystem::path& file) : content_(std::make_unique<Content>()) {
  Content& c = *content_;
  c.path = file;
  errno = 0;
  c.stream.open(file, std::ios::binary);
  if (!c.stream) {
    throw InputError(file, Place::whole_file(), "a file that can be read",
                     std::generic_category().message(errno));
  }
  std::vector<std::byte> beginning = take_bytes(c.stream, kMostHeaderBytes);
  const std::size_t known = beginning.size();
  FileCursor cursor(file, std::move(beginning));
  PlyHeader header = read_ply_header(cursor);
  if (header.format == PlyFormat::kAscii) {
    throw InputError(file, Place::whole_file(), "a binary PLY file", "one in ascii");
  }
  if (header.elements.empty() || header.elements.front().name != "vertex" ||
      header.elements.front().has_list() || header.elements.front().scalar_bytes() == 0) {
    throw InputError(file, Place::whole_file(), "points without lists before any other element",
                     header.elements.empty() ? "no element" : header.elements.front().name);
  }
  c.vertex = std::move(header.elements.front());
  c.swap_bytes = header.format == PlyFormat::kBigEndian;
  const std::size_t begin = known - cursor.rest().size();
  const std::size_t record = c.vertex.scalar_bytes();
  const std::uintmax_t bytes = std::filesystem::file_size(file);
  if (c.vertex.count > (bytes - begin) / record) {
    throw InputError(file, Place::whole_file(),
                     fmt::format("{} points of {} bytes", c.vertex.count, record),
                     fmt::format("{} bytes", bytes - begin));
  }
  c.stream.clear();
  c.stream.seekg(static_cast<std::streamoff>(begin));
}

PlyBlocks::PlyBlocks(PlyBlocks&&) noexcept = default;
PlyBlocks& PlyBlocks::operator=(PlyBlocks&&) noexcept = default;
PlyBlocks::~PlyBlocks() = default;

std::size_t PlyBlocks::size() const { return content_->vertex.count; }

std::optional<PointCloud> PlyBlocks::next() {
  Content& c = *content_;
  const std::size_t count = std::min(kBlockPoints, c.vertex.count - c.done);
  if (count == 0) return std::nullopt;
  const std::size_t record = c.vertex.scalar_bytes();
  const std::vector<std::byte> bytes = take_bytes(c.stream, count * record);
  if (bytes.size() < count * record) {
    throw InputError(c.path, Place::whole_file(),
                     fmt::format("{} points of {} bytes", c.vertex.count, record),
                     fmt::format("the end after {}", c.done + bytes.size() / record));
  }
  c.done += count;
  PointCloud cloud;
  std::size_t offset = 0;
  for (const PlyProperty& property : c.vertex.properties) {
    FieldValues values = make_values(property.type, count);
    decode(values, bytes.data() + offset, record, c.swap_bytes);
    offset += bytes_of(property.type);
    cloud.add(property.name, std::move(values));
  }
  return cloud;
}

}  // namespace traverse::dataset
