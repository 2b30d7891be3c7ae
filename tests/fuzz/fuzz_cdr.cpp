#include <array>
#include <string_view>

#include "fuzz/fuzz_messages.hpp"

/// The first byte chooses a type and how it is written; then a definition of its own, if the second
/// says so, up to a zero; the rest is the message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace traverse::bags;
  constexpr std::array<const char*, 8> kTypes{
      "sensor_msgs/Imu",        "sensor_msgs/PointCloud2", "sensor_msgs/NavSatFix",
      "tf2_msgs/TFMessage",     "nav_msgs/Odometry",       "livox_ros_driver2/CustomMsg",
      "sensor_msgs/JointState", "gps_msgs/GPSFix"};
  if (size < 2) return 0;
  Channel channel;
  channel.type = kTypes.at(data[0] % kTypes.size());
  channel.serialization = data[0] < 128 ? Serialization::kCdr : Serialization::kRos1;
  std::string_view rest(reinterpret_cast<const char*>(data) + 2, size - 2);
  if (data[1] % 4 != 0) {
    channel.definition_form = data[1] % 4 == 1 ? DefinitionForm::kIdl : DefinitionForm::kMsg;
    const auto end = std::min(rest.find('\0'), rest.size());
    channel.definition = std::string(rest.substr(0, end));
    rest = rest.substr(std::min(end + 1, rest.size()));
  }
  try {
    const MessageReader reader(definition_of(channel), channel.serialization);
    traverse::fuzz::walk(reader.read(std::as_bytes(std::span(rest.data(), rest.size()))),
                         reader.definition(), 0);
  } catch (const BadMessage&) {
  }
  return 0;
}
