#pragma once

#include <string>
#include <string_view>

namespace traverse::bags {

/// "sensor_msgs/msg/Imu" and "sensor_msgs::msg::dds_::Imu_" as "sensor_msgs/Imu".
std::string plain_type_name(std::string_view stored);

}  // namespace traverse::bags
