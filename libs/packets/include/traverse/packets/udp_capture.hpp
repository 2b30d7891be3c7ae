#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geometry/stamp.hpp"
#include "traverse/packets/packet_decoder.hpp"

namespace traverse::packets {

/// A UDP datagram as it stands in a capture.
struct Datagram {
  geometry::Stamp arrival;                ///< of its last part
  std::array<std::uint8_t, 16> source{};  ///< address; of IPv4 the first four bytes
  std::uint16_t source_port = 0;
  std::uint16_t target_port = 0;
  Bytes payload;  ///< holds until the next call
};

/// What a capture holds beside whole datagrams.
struct CaptureCounts {
  std::size_t frames = 0;
  std::size_t datagrams = 0;
  std::size_t not_udp = 0;     ///< other protocols
  std::size_t cut = 0;         ///< recorded shorter than they were, or shorter than they say
  std::size_t incomplete = 0;  ///< datagrams of which fragments are missing
};

/// Brings the parts of IP datagrams together, and looks into frames for UDP.
class UdpFrames {
 public:
  /// Kinds of frames, by the numbers of LINKTYPE_: 1 Ethernet, 12 and 101 raw IP, 113 and 276 Linux
  /// cooked, 0 and 108 BSD loopback, 228 IPv4, 229 IPv6.
  static bool knows(int link_type);

  explicit UdpFrames(int link_type) : link_type_(link_type) {}

  /// The datagram that is whole with this frame, if one is.
  std::optional<Datagram> add(Bytes frame, geometry::Stamp arrival);
  /// Counts what waits for its rest as incomplete.
  void finish();

  const CaptureCounts& counts() const { return counts_; }
  CaptureCounts& counts() { return counts_; }

 private:
  struct Address {
    std::array<std::uint8_t, 16> source{};
    std::array<std::uint8_t, 16> target{};
    bool operator==(const Address&) const = default;
  };
  struct Fragment {
    std::size_t offset;
    bool is_last;
    std::uint32_t id;
  };
  struct Pending {
    Address address;
    std::uint32_t id;
    std::vector<std::uint8_t> bytes;
    std::vector<bool> has;  ///< by units of eight bytes
    std::size_t size = 0;   ///< known with the last fragment
  };

  std::optional<Datagram> add_network(std::uint32_t ether_type, Bytes packet);
  std::optional<Datagram> add_ipv4(Bytes packet);
  std::optional<Datagram> add_ipv6(Bytes packet);
  std::optional<Datagram> add_fragment(const Address& address, const Fragment& fragment,
                                       Bytes part);
  std::optional<Datagram> add_udp(const Address& address, Bytes datagram);
  std::optional<Datagram> cut();

  int link_type_;
  CaptureCounts counts_;
  std::vector<Pending> pending_;
  std::vector<std::uint8_t> whole_;
};

/// A .pcap or .pcapng file, read through libpcap, which is loaded when the first is opened.
class UdpCapture {
 public:
  /// \throws files::InputError if it is no capture, its frames are of a kind that is not known, or
  /// libpcap is not installed
  explicit UdpCapture(const std::filesystem::path& file);
  ~UdpCapture();

  /// The next datagram; nothing at the end, or where the file is damaged (fault()).
  std::optional<Datagram> next();

  const CaptureCounts& counts() const;
  /// What is wrong with the rest of the file; empty: nothing.
  const std::string& fault() const;
  /// Bytes of frames read so far.
  std::uint64_t bytes_read() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether the file begins like a capture.
bool is_capture(const std::filesystem::path& file);

}  // namespace traverse::packets
