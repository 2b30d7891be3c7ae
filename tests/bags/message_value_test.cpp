#include "traverse/bags/message_value.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bags/made_messages.hpp"

namespace traverse::bags {
namespace {

using namespace traverse::testing;
using ::testing::HasSubstr;

constexpr std::int64_t kStamp = 1'700'000'001'234'567'891;
const std::vector<Wire> kWires{Wire::kRos1, Wire::kCdr, Wire::kCdrBigEndian};

std::span<const std::byte> as_bytes(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

Serialization serialization_of(Wire wire) {
  return wire == Wire::kRos1 ? Serialization::kRos1 : Serialization::kCdr;
}

MessageReader reader_of(const std::string& type, Wire wire) {
  return {parse_msg_definition(type, definition_text(type, wire), serialization_of(wire)),
          serialization_of(wire)};
}

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const BadMessage& error) {
    return error.what();
  }
  return "no error";
}

TEST(MessageValues, AnImuIsReadByItsDefinitionInEveryForm) {
  for (const Wire wire : kWires) {
    for (const std::string frame : {"", "i", "imu", "imu_link", "a_longer_frame"}) {
      const MessageReader reader = reader_of("sensor_msgs/Imu", wire);
      const std::string bytes = imu_message(wire, kStamp, frame, {1, 2, 3}, {4, 5, 6});
      const MessageValue value = reader.read(as_bytes(bytes));
      EXPECT_EQ(value["header"]["stamp"].time_ns(), kStamp);
      EXPECT_EQ(value["header"]["frame_id"].text(), frame);
      EXPECT_EQ(value["orientation"]["w"].number(), 1);
      EXPECT_EQ(value["angular_velocity"]["z"].number(), 3);
      EXPECT_EQ(value["linear_acceleration"]["x"].number(), 4);
      EXPECT_EQ(value["linear_acceleration_covariance"].numbers().count, 9U);
    }
  }
}

TEST(MessageValues, PointFieldsAndBytesAreFoundBehindTextsOfAnyLength) {
  CloudMessage cloud;
  cloud.fields = {{"x", 0, 7}, {"intensity", 4, 7}, {"t", 8, 6}};
  cloud.width = 2;
  cloud.point_step = 12;
  cloud.row_step = 24;
  cloud.data = std::string(24, 'd');
  for (const Wire wire : kWires) {
    const MessageReader reader = reader_of("sensor_msgs/PointCloud2", wire);
    const std::string bytes = cloud_message(wire, kStamp, "lidar", cloud);
    const MessageValue value = reader.read(as_bytes(bytes));
    std::string names;
    value["fields"].for_each([&](const MessageValue& field) {
      names +=
          std::string(field["name"].text()) + "@" + std::to_string(field["offset"].integer()) + " ";
    });
    EXPECT_EQ(names, "x@0 intensity@4 t@8 ");
    EXPECT_EQ(value["data"].bytes().size(), 24U);
    EXPECT_EQ(value["data"].bytes().back(), std::byte{'d'});
    EXPECT_EQ(value["width"].integer(), 2);
    EXPECT_EQ(value["is_dense"].integer(), 1) << "stands behind the data";
  }
}

TEST(MessageValues, ArraysOfStructuresGiveColumnsAlignedAsTheyAreWritten) {
  const std::string text =
      "uint8[3] before\nPoint[] points\n====\nMSG: a/Point\nuint32 offset_time\nfloat32 x\nuint8 "
      "line";
  for (const Wire wire : kWires) {
    MessageWriter writer(wire);
    writer.u8(1).u8(2).u8(3).u32(3);
    for (int i = 0; i < 3; ++i) {
      writer.u32(static_cast<std::uint64_t>(100 + i)).number(0.5F + static_cast<float>(i)).u8(i);
    }
    const std::string bytes = writer.take();
    const MessageReader reader(parse_msg_definition("a/Cloud", text, serialization_of(wire)),
                               serialization_of(wire));
    const MessageValue value = reader.read(as_bytes(bytes));
    EXPECT_EQ(value["points"].size(), 3U);
    EXPECT_EQ(value["points"].column("offset_time")[2], 102);
    EXPECT_EQ(value["points"].column("x")[1], 1.5);
    EXPECT_EQ(value["points"].column("line")[2], 2);
  }
}

TEST(MessageValues, IdlGivesTheSameAsMsg) {
  const std::string idl =
      R"(================================================================================
IDL: sensor_msgs/msg/Imu
#include "geometry_msgs/msg/Quaternion.idl"
module sensor_msgs { module msg {
  typedef double double__9[9];
  @verbatim (language="comment", text="says (a lot); of \"things\"")
  struct Imu {
    std_msgs::msg::Header header;
    geometry_msgs::msg::Quaternion orientation;
    @verbatim (language="comment", text="x")
    double__9 orientation_covariance;
    geometry_msgs::msg::Vector3 angular_velocity;
    double angular_velocity_covariance[9];
    geometry_msgs::msg::Vector3 linear_acceleration;
    double__9 linear_acceleration_covariance;
  };
}; };
================================================================================
IDL: std_msgs/msg/Header
module std_msgs { module msg { struct Header { builtin_interfaces::msg::Time stamp; string frame_id; }; }; };
================================================================================
IDL: builtin_interfaces/msg/Time
module builtin_interfaces { module msg { struct Time { int32 sec; unsigned long nanosec; }; }; };
================================================================================
IDL: geometry_msgs/msg/Quaternion
module geometry_msgs { module msg { struct Quaternion { @default (value=0.0) double x, y, z; double w; }; }; };
================================================================================
IDL: geometry_msgs/msg/Vector3
module geometry_msgs { module msg { struct Vector3 { double x; double y; double z; }; }; };
)";
  const MessageReader reader(parse_idl_definition("sensor_msgs/Imu", idl), Serialization::kCdr);
  const std::string bytes = imu_message(Wire::kCdr, kStamp, "imu", {1, 2, 3}, {4, 5, 6});
  const MessageValue value = reader.read(as_bytes(bytes));
  EXPECT_EQ(value["header"]["stamp"].time_ns(), kStamp);
  EXPECT_EQ(value["angular_velocity"]["y"].number(), 2);
  EXPECT_EQ(value["linear_acceleration"]["z"].number(), 6);
}

TEST(MessageValues, BuiltInDefinitionsAreThoseOfRos2) {
  for (const std::string type :
       {"sensor_msgs/Imu", "sensor_msgs/PointCloud2", "sensor_msgs/NavSatFix", "tf2_msgs/TFMessage",
        "nav_msgs/Odometry", "velodyne_msgs/VelodyneScan", "pandar_msgs/PandarScan",
        "nebula_msgs/NebulaPackets", "ouster_ros/PacketMsg"}) {
    const MessageDefinition stored =
        parse_msg_definition(type, definition_text(type, Wire::kCdr), Serialization::kCdr);
    Channel channel;
    channel.type = type;
    channel.serialization = Serialization::kCdr;
    const MessageDefinition known = definition_of(channel);
    ASSERT_EQ(known.structures.size(), stored.structures.size()) << type;
    for (std::size_t i = 0; i < known.structures.size(); ++i) {
      EXPECT_EQ(known.structures[i].name, stored.structures[i].name);
      EXPECT_EQ(known.structures[i].least_bytes, stored.structures[i].least_bytes);
      ASSERT_EQ(known.structures[i].fields.size(), stored.structures[i].fields.size());
      for (std::size_t f = 0; f < known.structures[i].fields.size(); ++f) {
        EXPECT_EQ(known.structures[i].fields[f].name, stored.structures[i].fields[f].name);
      }
    }
  }
  Channel unknown;
  unknown.type = "my_msgs/Thing";
  unknown.serialization = Serialization::kCdr;
  EXPECT_EQ(error_of([&] { definition_of(unknown); }), "no definition of my_msgs/Thing is stored");
}

TEST(MessageValues, AMessageThatEndsTooEarlyIsRefusedWhereverItIsCut) {
  for (const Wire wire : kWires) {
    const MessageReader reader = reader_of("sensor_msgs/Imu", wire);
    const std::string bytes = imu_message(wire, kStamp, "imu", {1, 2, 3}, {4, 5, 6});
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string cut = bytes.substr(0, size);
      EXPECT_NE(error_of([&] { reader.read(as_bytes(cut)); }), "no error") << size;
    }
    EXPECT_EQ(error_of([&] { reader.read(as_bytes(bytes)); }), "no error");
  }
}

TEST(MessageValues, DefinitionsThatMakeNoSenseAreRefused) {
  const auto error = [](const std::string& text) {
    return error_of([&] { parse_msg_definition("a/B", text, Serialization::kCdr); });
  };
  EXPECT_THAT(error("C c"), HasSubstr("a definition of a/B without that of C"));
  EXPECT_THAT(error("C c\n====\nMSG: a/C\nB b"), HasSubstr("a/B holds itself"));
  EXPECT_THAT(error("uint8[x] a"), HasSubstr("'uint8[x] a'"));
  EXPECT_THAT(error("justoneword"), HasSubstr("'justoneword'"));
  std::string bomb = "C9 a\nC9 b\n";
  for (int i = 9; i > 0; --i) {
    bomb += "====\nMSG: a/C" + std::to_string(i) + "\n";
    for (int k = 0; k < 10; ++k) {
      bomb += (i > 1 ? "C" + std::to_string(i - 1) : std::string("uint8")) + " f" +
              std::to_string(k) + "\n";
    }
  }
  EXPECT_THAT(error(bomb), HasSubstr("too many values"));
  std::string empty = "C[] c\n====\nMSG: a/C\nuint8 one\n";
  for (int i = 0; i < 100; ++i) empty += "uint8[0] e" + std::to_string(i) + "\n";
  EXPECT_THAT(error(empty), HasSubstr("an array of C, most of which is empty"));
  EXPECT_EQ(error("string<=10 a\nfloat64[<=3] b\nint32 c 5\nint32 D=7\nstring e \"#\"\n"),
            "no error");
}

TEST(MessageValues, AnIdlDefinitionThatIsCutAnywhereIsRefused) {
  const std::string whole =
      "module a { module msg { typedef double d9[9]; @unit (value=\"m\") struct B { long x; "
      "sequence<float, 4> y; d9 z; }; }; };";
  EXPECT_EQ(parse_idl_definition("a/B", whole).structures.front().fields.size(), 3U);
  const std::size_t end = whole.rfind('}');
  for (std::size_t size = 0; size <= end; ++size) {
    EXPECT_NE(error_of([&] { parse_idl_definition("a/B", whole.substr(0, size)); }), "no error")
        << size;
  }
}

TEST(MessageValues, OtherRepresentationsAreNamed) {
  const MessageReader reader = reader_of("sensor_msgs/Imu", Wire::kCdr);
  std::string bytes = imu_message(Wire::kCdr, kStamp, "imu", {1, 2, 3}, {4, 5, 6});
  bytes[1] = '\x07';
  EXPECT_THAT(error_of([&] { reader.read(as_bytes(bytes)); }),
              HasSubstr("the representation 00 07, not CDR"));
}

}  // namespace
}  // namespace traverse::bags
