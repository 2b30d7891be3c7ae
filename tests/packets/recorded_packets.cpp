#include "packets/recorded_packets.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <sqlite3.h>
#include <sstream>
#include <stdexcept>
#include <string>

namespace traverse::testing {

namespace {

/// Reads CDR, lowest byte first, as far as packets need it.
class CdrReader {
 public:
  explicit CdrReader(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  std::uint32_t u32() {
    at_ = 4 + (at_ - 4 + 3) / 4 * 4;
    std::uint32_t value = 0;
    std::memcpy(&value, take(4), 4);
    return value;
  }
  const std::uint8_t* take(std::size_t count) {
    if (at_ + count > bytes_.size()) throw std::runtime_error("a message that ends too early");
    at_ += count;
    return bytes_.data() + at_ - count;
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 4;
};

void add_packets(std::vector<std::uint8_t> message, bool is_velodyne,
                 std::vector<RecordedPacket>& packets) {
  CdrReader reader(std::move(message));
  reader.u32();
  reader.u32();
  reader.take(reader.u32());
  const std::uint32_t count = reader.u32();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::int64_t seconds = reader.u32();
    const std::int64_t nanoseconds = reader.u32();
    RecordedPacket packet{geometry::Stamp{seconds * 1'000'000'000 + nanoseconds}, {}};
    const std::size_t room = is_velodyne ? 1206 : 1500;
    const std::uint8_t* bytes = reader.take(room);
    const std::size_t size = is_velodyne ? room : reader.u32();
    packet.bytes.assign(bytes, bytes + size);
    packets.push_back(std::move(packet));
  }
}

}  // namespace

std::vector<RecordedPacket> packets_of_bag(const std::filesystem::path& db3) {
  sqlite3* opened = nullptr;
  if (sqlite3_open_v2(db3.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr) != SQLITE_OK) {
    throw std::runtime_error("cannot open " + db3.string());
  }
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> bag(opened, sqlite3_close);
  sqlite3_stmt* prepared = nullptr;
  sqlite3_prepare_v2(opened,
                     "select topics.type, messages.data from messages join topics on "
                     "topics.id = messages.topic_id order by messages.timestamp",
                     -1, &prepared, nullptr);
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> rows(prepared, sqlite3_finalize);
  std::vector<RecordedPacket> packets;
  while (sqlite3_step(prepared) == SQLITE_ROW) {
    const std::string type = reinterpret_cast<const char*>(sqlite3_column_text(prepared, 0));
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(prepared, 1));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(prepared, 1));
    add_packets({data, data + size}, type.find("velodyne") != std::string::npos, packets);
  }
  return packets;
}

std::vector<std::array<float, 3>> points_of_pcd(const std::filesystem::path& pcd) {
  std::ifstream in(pcd, std::ios::binary);
  std::size_t stride = 0;
  std::size_t count = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "SIZE") {
      for (std::size_t size = 0; words >> size;) stride += size;
    }
    if (key == "POINTS") words >> count;
    if (key == "DATA") break;
  }
  std::vector<std::array<float, 3>> points(count);
  std::vector<char> record(stride);
  for (auto& point : points) {
    if (!in.read(record.data(), static_cast<std::streamsize>(stride))) {
      throw std::runtime_error(pcd.string() + " ends too early");
    }
    std::memcpy(point.data(), record.data(), sizeof(point));
  }
  return points;
}

}  // namespace traverse::testing
