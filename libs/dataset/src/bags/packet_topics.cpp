#include "bags/packet_topics.hpp"

#include <cstdint>
#include <span>

#include <fmt/format.h>

#include "bags/ros_messages.hpp"

namespace traverse::dataset {

using bags::MessageValue;
using geometry::Stamp;

namespace {

packets::Bytes packet_in(const MessageValue& value) {
  const std::span<const std::byte> bytes = value.bytes();
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

}  // namespace

void for_each_packet(const MessageValue& message, Stamp log_time,
                     const std::function<void(packets::Bytes, Stamp)>& use) {
  if (const MessageValue* buffer = message.find("buf")) {
    use(packet_in(*buffer), log_time);
    return;
  }
  const MessageValue* many = message.find("packets");
  if (many == nullptr) {
    use(packet_in(message["data"]), log_time);
    return;
  }
  if (many->size() == 0) throw UnusableMessage("a message without packets");
  const Stamp otherwise = header_stamp(message).value_or(log_time);
  many->for_each([&](const MessageValue& packet) {
    packets::Bytes bytes = packet_in(packet["data"]);
    if (const MessageValue* size = packet.find("size")) {
      const auto used = static_cast<std::uint64_t>(size->integer());
      if (used > bytes.size()) {
        throw UnusableMessage(
            fmt::format("a packet of {} bytes in {} bytes of data", used, bytes.size()));
      }
      bytes = bytes.first(static_cast<std::size_t>(used));
    }
    const std::int64_t ns = packet["stamp"].time_ns();
    use(bytes, ns == 0 ? otherwise : Stamp{ns});
  });
}

}  // namespace traverse::dataset
