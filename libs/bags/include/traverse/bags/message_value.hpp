#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/bags/message_definition.hpp"

namespace traverse::bags {

/// Numbers of one kind in memory, a step from one to the next, in either byte order.
struct NumberColumn {
  Primitive primitive = Primitive::kUint8;
  std::size_t count = 0;
  const std::byte* first = nullptr;
  std::size_t step = 0;
  bool swap_bytes = false;

  double operator[](std::size_t index) const;
};

/// Bytes of a message on the way from front to back.
struct MessageBytes {
  std::span<const std::byte> bytes;  ///< behind CDR's own header
  std::size_t at = 0;
  bool is_cdr = false;
  bool swap_bytes = false;
};

/// A value of a message: a number, a text, a structure or many of one of these. Refers to the
/// message's bytes and to its definition. Arrays are looked at where they are, so that a message
/// takes little memory whatever it holds.
class MessageValue {
 public:
  using Field = MessageDefinition::Field;

  /// The field of a structure. \throws BadMessage if there is none of that name
  const MessageValue& operator[](std::string_view name) const;
  const MessageValue* find(std::string_view name) const;

  /// \throws BadMessage if it is not one, as all here
  double number() const;
  std::int64_t integer() const;
  std::string_view text() const;
  /// Nanoseconds of a time of ROS 1 or of a structure with sec and nanosec.
  std::int64_t time_ns() const;

  /// How many values an array or a sequence has.
  std::size_t size() const { return count_; }
  NumberColumn numbers() const;
  std::span<const std::byte> bytes() const;
  /// One number of each structure of an array, whose structures all have one size.
  NumberColumn column(std::string_view name) const;
  /// Calls `use` with each of an array of structures or texts.
  void for_each(const std::function<void(const MessageValue&)>& use) const;

 private:
  friend class MessageReader;

  const MessageDefinition* definition_ = nullptr;
  const Field* field_ = nullptr;  ///< null: the message itself
  MessageBytes begin_;            ///< where it begins; of arrays their first value
  std::size_t count_ = 1;
  std::vector<MessageValue> fields_;  ///< of a structure
  std::size_t structure_ = 0;

  static MessageValue read_structure(const MessageDefinition& definition, std::size_t structure,
                                     const Field* field, MessageBytes& bytes);
  static MessageValue read_field(const MessageDefinition& definition, const Field& field,
                                 MessageBytes& bytes);
  static void skip_structure(const MessageDefinition& definition, std::size_t structure,
                             MessageBytes& bytes);
  static void skip_field(const MessageDefinition& definition, const Field& field,
                         MessageBytes& bytes);
  static std::size_t count_of(const MessageDefinition& definition, const Field& field,
                              MessageBytes& bytes);
  [[noreturn]] void fail(const std::string& expected) const;
  bool is_single(bool wants_structure) const;
};

/// Reads messages of one type: ROS 1 serialization, or CDR (XCDR version 1) in either byte order.
class MessageReader {
 public:
  /// \throws BadMessage for a serialization that is not known
  MessageReader(MessageDefinition definition, Serialization serialization);

  /// \returns values that refer to `bytes` and to this reader
  /// \throws BadMessage if the bytes end before the message does, or are written in another way
  MessageValue read(std::span<const std::byte> bytes) const;

  const MessageDefinition& definition() const { return *definition_; }

 private:
  std::shared_ptr<const MessageDefinition> definition_;
  Serialization serialization_;
};

}  // namespace traverse::bags
