#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/bags/message_container.hpp"

namespace traverse::bags {

/// What a field can be that is not made of others.
enum class Primitive {
  kBool,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble,
  kString,
  kTime,      ///< of ROS 1: seconds and nanoseconds, unsigned
  kDuration,  ///< of ROS 1: the same, signed
};

/// Bytes of a value; 0 for a string. Times are two numbers of four bytes each.
std::size_t bytes_of(Primitive primitive);

/// A definition that cannot be understood, or a message that does not follow it.
class BadMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the messages of a type consist of, and the types that they use.
struct MessageDefinition {
  enum class Count { kOne, kFixed, kMany };
  struct Field {
    std::string name;
    Primitive primitive = Primitive::kUint8;
    std::optional<std::size_t> structure;  ///< index into `structures`; nothing: a primitive
    Count count = Count::kOne;
    std::uint64_t fixed = 0;  ///< values, for kFixed
  };
  struct Structure {
    std::string name;  ///< "geometry_msgs/Vector3"
    std::vector<Field> fields;
    std::uint64_t least_bytes = 0;  ///< that a value takes
  };
  std::vector<Structure> structures;  ///< the first is the message
};

/// \param type "sensor_msgs/Imu" \param text the lines of its fields, behind them those of the
/// types that it uses, each behind a line of "=" and "MSG: package/Type" \throws BadMessage with
/// what is wrong
MessageDefinition parse_msg_definition(std::string_view type, std::string_view text,
                                       Serialization serialization);
/// OMG IDL, as ROS 2 writes it. \throws BadMessage
MessageDefinition parse_idl_definition(std::string_view type, std::string_view text);

/// The text of a type's definition that is built in, in the form of parse_msg_definition(): for
/// databases of before ROS 2 Iron, which hold none. Empty: not known.
std::string known_definition(std::string_view type);

/// The definition that the channel brings, or else the one that is built in.
/// \throws BadMessage if there is neither or it cannot be understood
MessageDefinition definition_of(const Channel& channel);

}  // namespace traverse::bags
