#pragma once

#include <string>
#include <string_view>

#include "traverse/bags/message_writer.hpp"

namespace traverse::bags {

/// The definition of a type that is written, whole, with the types that it uses behind it.
/// \throws std::invalid_argument for a type that is none of these
std::string written_definition(std::string_view type, Wire wire);

/// By which programs of ROS 1 tell whether they know the same definition: MD5 of its text without
/// comments. Source: wiki.ros.org/ROS/Technical Overview, "Message serialization and msg MD5 sums".
/// \throws std::invalid_argument
std::string_view ros1_digest(std::string_view type);

}  // namespace traverse::bags
