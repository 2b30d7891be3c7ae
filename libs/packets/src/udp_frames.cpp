#include <algorithm>

#include "traverse/packets/udp_capture.hpp"

namespace traverse::packets {

namespace {

constexpr std::uint32_t kIpv4 = 0x0800;
constexpr std::uint32_t kIpv6 = 0x86DD;
constexpr std::uint8_t kUdp = 17;
constexpr std::size_t kMostPending = 64;
constexpr std::size_t kMostBytes = 65535;

/// Networks send the highest byte first.
std::uint32_t net16(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 8 | bytes[at + 1];
}

std::uint32_t net32(Bytes bytes, std::size_t at) {
  return net16(bytes, at) << 16 | net16(bytes, at + 2);
}

bool is_vlan(std::uint32_t ether_type) { return ether_type == 0x8100 || ether_type == 0x88A8; }

/// Before what these headers follow: hop by hop, routing, destination.
bool is_extension(std::uint8_t header) { return header == 0 || header == 43 || header == 60; }

}  // namespace

bool UdpFrames::knows(int link_type) {
  constexpr std::array kKnown{0, 1, 12, 101, 108, 113, 228, 229, 276};
  return std::find(kKnown.begin(), kKnown.end(), link_type) != kKnown.end();
}

std::optional<Datagram> UdpFrames::cut() {
  ++counts_.cut;
  return std::nullopt;
}

std::optional<Datagram> UdpFrames::add(Bytes frame, geometry::Stamp arrival) {
  ++counts_.frames;
  std::size_t header = 0;
  std::uint32_t type = 0;
  switch (link_type_) {
    case 1:
      header = 14;
      if (frame.size() >= header) type = net16(frame, 12);
      break;
    case 113:
      header = 16;
      if (frame.size() >= header) type = net16(frame, 14);
      break;
    case 276:
      header = 20;
      if (frame.size() >= header) type = net16(frame, 0);
      break;
    case 0:
    case 108:
      header = 4;
      break;
    default:
      break;
  }
  if (frame.size() <= header) return cut();
  Bytes packet = frame.subspan(header);
  while (is_vlan(type)) {
    if (packet.size() <= 4) return cut();
    type = net16(packet, 2);
    packet = packet.subspan(4);
  }
  if (link_type_ != 1 && link_type_ != 113 && link_type_ != 276) {
    type = packet[0] >> 4 == 6 ? kIpv6 : kIpv4;
  }
  auto datagram = add_network(type, packet);
  if (datagram) datagram->arrival = arrival;
  return datagram;
}

std::optional<Datagram> UdpFrames::add_network(std::uint32_t ether_type, Bytes packet) {
  if (ether_type == kIpv4) return add_ipv4(packet);
  if (ether_type == kIpv6) return add_ipv6(packet);
  ++counts_.not_udp;
  return std::nullopt;
}

std::optional<Datagram> UdpFrames::add_ipv4(Bytes packet) {
  if (packet.size() < 20) return cut();
  const std::size_t header = static_cast<std::size_t>(packet[0] & 15) * 4;
  const std::size_t total = net16(packet, 2);
  if (packet[0] >> 4 != 4 || packet[9] != kUdp) {
    ++counts_.not_udp;
    return std::nullopt;
  }
  // Senders that leave the length to their network card write zero.
  const std::size_t end = total == 0 ? packet.size() : total;
  if (header < 20 || end < header || packet.size() < end) return cut();
  Address address;
  std::copy_n(packet.begin() + 12, 4, address.source.begin());
  std::copy_n(packet.begin() + 16, 4, address.target.begin());
  const std::uint32_t flags = net16(packet, 6);
  const Bytes part = packet.subspan(header, end - header);
  const bool has_more = (flags & 0x2000) != 0;
  const std::size_t offset = static_cast<std::size_t>(flags & 0x1FFF) * 8;
  if (!has_more && offset == 0) return add_udp(address, part);
  return add_fragment(address, {offset, !has_more, net16(packet, 4)}, part);
}

std::optional<Datagram> UdpFrames::add_ipv6(Bytes packet) {
  constexpr std::size_t kHeader = 40;
  constexpr std::uint8_t kFragment = 44;
  if (packet.size() < kHeader || packet.size() < kHeader + net16(packet, 4)) return cut();
  Address address;
  std::copy_n(packet.begin() + 8, 16, address.source.begin());
  std::copy_n(packet.begin() + 24, 16, address.target.begin());
  std::uint8_t next = packet[6];
  Bytes rest = packet.subspan(kHeader, net16(packet, 4));
  while (is_extension(next)) {
    if (rest.size() < 8) return cut();
    const std::size_t length = (static_cast<std::size_t>(rest[1]) + 1) * 8;
    if (rest.size() < length) return cut();
    next = rest[0];
    rest = rest.subspan(length);
  }
  if (next == kFragment) {
    if (rest.size() < 8) return cut();
    if (rest[0] == kUdp) {
      const std::uint32_t field = net16(rest, 2);
      return add_fragment(address, {field & 0xFFF8, (field & 1) == 0, net32(rest, 4)},
                          rest.subspan(8));
    }
    next = rest[0];
  }
  if (next == kUdp) return add_udp(address, rest);
  ++counts_.not_udp;
  return std::nullopt;
}

std::optional<Datagram> UdpFrames::add_fragment(const Address& address, const Fragment& fragment,
                                                Bytes part) {
  const std::size_t end = fragment.offset + part.size();
  if (part.empty() || end > kMostBytes || (!fragment.is_last && part.size() % 8 != 0)) return cut();
  auto found = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& pending) {
    return pending.id == fragment.id && pending.address == address;
  });
  if (found == pending_.end()) {
    if (pending_.size() == kMostPending) {
      pending_.erase(pending_.begin());
      ++counts_.incomplete;
    }
    pending_.push_back({address, fragment.id, {}, {}, 0});
    found = pending_.end() - 1;
  }
  if (found->bytes.size() < end) {
    found->bytes.resize(end);
    found->has.resize((end + 7) / 8);
  }
  std::copy(part.begin(), part.end(),
            found->bytes.begin() + static_cast<std::ptrdiff_t>(fragment.offset));
  for (std::size_t unit = fragment.offset / 8; unit < (end + 7) / 8; ++unit) {
    found->has[unit] = true;
  }
  if (fragment.is_last) found->size = end;
  const bool is_whole =
      found->size != 0 && found->bytes.size() == found->size &&
      std::all_of(found->has.begin(), found->has.end(), [](bool has) { return has; });
  if (!is_whole) return std::nullopt;
  whole_ = std::move(found->bytes);
  pending_.erase(found);
  return add_udp(address, whole_);
}

std::optional<Datagram> UdpFrames::add_udp(const Address& address, Bytes datagram) {
  constexpr std::size_t kHeader = 8;
  if (datagram.size() < kHeader) return cut();
  std::size_t length = net16(datagram, 4);
  if (length == 0) length = datagram.size();
  if (length < kHeader || datagram.size() < length) return cut();
  ++counts_.datagrams;
  Datagram found;
  found.source = address.source;
  found.source_port = static_cast<std::uint16_t>(net16(datagram, 0));
  found.target_port = static_cast<std::uint16_t>(net16(datagram, 2));
  found.payload = datagram.subspan(kHeader, length - kHeader);
  return found;
}

void UdpFrames::finish() {
  counts_.incomplete += pending_.size();
  pending_.clear();
}

}  // namespace traverse::packets
