#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace traverse::testing {

/// A .pcap file with nanoseconds, built byte by byte.
class MadeCapture {
 public:
  explicit MadeCapture(std::uint32_t link_type = 1) {
    for (const std::uint32_t word : {0xA1B23C4DU, 0x00040002U, 0U, 0U, 262144U, link_type}) {
      put32(word);
    }
  }

  using Bytes = std::vector<std::uint8_t>;

  void add_frame(const Bytes& frame, std::int64_t ns) { add_cut_frame(frame, ns, frame.size()); }
  void add_cut_frame(const Bytes& frame, std::int64_t ns, std::size_t length) {
    put32(static_cast<std::uint32_t>(ns / 1'000'000'000));
    put32(static_cast<std::uint32_t>(ns % 1'000'000'000));
    put32(static_cast<std::uint32_t>(frame.size()));
    put32(static_cast<std::uint32_t>(length));
    bytes_.insert(bytes_.end(), frame.begin(), frame.end());
  }
  void add_datagram(const Bytes& payload, std::int64_t ns, std::uint16_t port = 2368) {
    add_frame(ethernet(ipv4(udp(payload, port))), ns);
  }

  static Bytes udp(const Bytes& payload, std::uint16_t port) {
    Bytes datagram{0x1F, 0x90};
    add16(datagram, port);
    add16(datagram, static_cast<std::uint32_t>(payload.size() + 8));
    add16(datagram, 0);
    datagram.insert(datagram.end(), payload.begin(), payload.end());
    return datagram;
  }
  /// \param flags_and_offset 0x2000: more fragments; offset in units of eight bytes
  static Bytes ipv4(const Bytes& part, std::uint32_t id = 1, std::uint32_t flags_and_offset = 0) {
    Bytes packet{0x45, 0};
    add16(packet, static_cast<std::uint32_t>(part.size() + 20));
    add16(packet, id);
    add16(packet, flags_and_offset);
    for (const int byte : {64, 17, 0, 0, 192, 168, 1, 201, 255, 255, 255, 255}) {
      packet.push_back(static_cast<std::uint8_t>(byte));
    }
    packet.insert(packet.end(), part.begin(), part.end());
    return packet;
  }
  static Bytes ethernet(const Bytes& packet, const Bytes& type = {0x08, 0x00}) {
    Bytes frame(12, 0xAB);
    frame.insert(frame.end(), type.begin(), type.end());
    frame.insert(frame.end(), packet.begin(), packet.end());
    return frame;
  }

  void write(const std::filesystem::path& file) const {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes_.data()),
              static_cast<std::streamsize>(bytes_.size()));
  }
  std::size_t size() const { return bytes_.size(); }
  void cut_to(std::size_t size) { bytes_.resize(size); }

 private:
  static void add16(Bytes& bytes, std::uint32_t value) {
    bytes.push_back(static_cast<std::uint8_t>(value >> 8 & 255));
    bytes.push_back(static_cast<std::uint8_t>(value & 255));
  }
  void put32(std::uint32_t value) {
    for (unsigned i = 0; i < 4; ++i)
      bytes_.push_back(static_cast<std::uint8_t>(value >> 8 * i & 255));
  }

  Bytes bytes_;
};

}  // namespace traverse::testing
