#include "traverse/bags/message_value.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace traverse::bags {

namespace {

using Count = MessageDefinition::Count;

template <typename Number>
Number number_at(const std::byte* at, bool swap_bytes) {
  std::byte bytes[sizeof(Number)];
  std::memcpy(bytes, at, sizeof(Number));
  if (swap_bytes) std::reverse(bytes, bytes + sizeof(Number));
  Number value;
  std::memcpy(&value, bytes, sizeof(Number));
  return value;
}

double double_at(Primitive primitive, const std::byte* at, bool swap_bytes) {
  switch (primitive) {
    case Primitive::kBool:
    case Primitive::kUint8:
      return number_at<std::uint8_t>(at, swap_bytes);
    case Primitive::kInt8:
      return number_at<std::int8_t>(at, swap_bytes);
    case Primitive::kInt16:
      return number_at<std::int16_t>(at, swap_bytes);
    case Primitive::kUint16:
      return number_at<std::uint16_t>(at, swap_bytes);
    case Primitive::kInt32:
      return number_at<std::int32_t>(at, swap_bytes);
    case Primitive::kUint32:
      return number_at<std::uint32_t>(at, swap_bytes);
    case Primitive::kInt64:
      return static_cast<double>(number_at<std::int64_t>(at, swap_bytes));
    case Primitive::kUint64:
      return static_cast<double>(number_at<std::uint64_t>(at, swap_bytes));
    case Primitive::kFloat:
      return number_at<float>(at, swap_bytes);
    case Primitive::kDouble:
      return number_at<double>(at, swap_bytes);
    default:
      return 0;
  }
}

/// Of CDR, from which a value begins at a multiple of its size.
std::size_t alignment_of(Primitive primitive) {
  if (primitive == Primitive::kString) return 4;
  const bool is_time = primitive == Primitive::kTime || primitive == Primitive::kDuration;
  return is_time ? 4 : bytes_of(primitive);
}

void align(MessageBytes& bytes, std::size_t size) {
  if (bytes.is_cdr && size > 1) bytes.at = (bytes.at + size - 1) / size * size;
}

[[noreturn]] void fail_short(const MessageBytes& bytes) {
  throw BadMessage(fmt::format("a message of {} bytes that is longer by its definition",
                               bytes.bytes.size() + (bytes.is_cdr ? 4 : 0)));
}

/// Moves on by `count` bytes. \returns where they begin
const std::byte* pass(MessageBytes& bytes, std::uint64_t count) {
  if (bytes.at > bytes.bytes.size() || count > bytes.bytes.size() - bytes.at) fail_short(bytes);
  const std::byte* first = bytes.bytes.data() + bytes.at;
  bytes.at += static_cast<std::size_t>(count);
  return first;
}

std::uint32_t pass_count(MessageBytes& bytes) {
  align(bytes, 4);
  return number_at<std::uint32_t>(pass(bytes, 4), bytes.swap_bytes);
}

void pass_primitive(Primitive primitive, MessageBytes& bytes) {
  if (primitive == Primitive::kString) {
    pass(bytes, pass_count(bytes));
  } else {
    align(bytes, alignment_of(primitive));
    pass(bytes, bytes_of(primitive));
  }
}

}  // namespace

double NumberColumn::operator[](std::size_t index) const {
  return double_at(primitive, first + index * step, swap_bytes);
}

std::size_t MessageValue::count_of(const MessageDefinition& definition, const Field& field,
                                   MessageBytes& bytes) {
  const std::uint64_t count = field.count == Count::kFixed ? field.fixed : pass_count(bytes);
  std::uint64_t each = bytes_of(field.primitive);
  if (field.primitive == Primitive::kString) each = 4;
  if (field.structure) each = definition.structures[*field.structure].least_bytes;
  const std::uint64_t left = bytes.bytes.size() - std::min(bytes.at, bytes.bytes.size());
  if (count > 0 && (each == 0 || count > left / each)) fail_short(bytes);
  return static_cast<std::size_t>(count);
}

void MessageValue::skip_structure(const MessageDefinition& definition, std::size_t structure,
                                  MessageBytes& bytes) {
  for (const Field& field : definition.structures[structure].fields) {
    skip_field(definition, field, bytes);
  }
}

void MessageValue::skip_field(const MessageDefinition& definition, const Field& field,
                              MessageBytes& bytes) {
  const std::size_t count = field.count == Count::kOne ? 1 : count_of(definition, field, bytes);
  if (!field.structure && field.primitive != Primitive::kString && field.count != Count::kOne) {
    if (count == 0) return;
    align(bytes, alignment_of(field.primitive));
    pass(bytes, std::uint64_t{count} * bytes_of(field.primitive));
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (field.structure) {
      skip_structure(definition, *field.structure, bytes);
    } else {
      pass_primitive(field.primitive, bytes);
    }
  }
}

MessageValue MessageValue::read_structure(const MessageDefinition& definition,
                                          std::size_t structure, const Field* field,
                                          MessageBytes& bytes) {
  MessageValue value;
  value.definition_ = &definition;
  value.field_ = field;
  value.structure_ = structure;
  value.begin_ = bytes;
  const auto& fields = definition.structures[structure].fields;
  value.fields_.reserve(fields.size());
  for (const Field& inner : fields) value.fields_.push_back(read_field(definition, inner, bytes));
  return value;
}

MessageValue MessageValue::read_field(const MessageDefinition& definition, const Field& field,
                                      MessageBytes& bytes) {
  if (field.count == Count::kOne && field.structure) {
    return read_structure(definition, *field.structure, &field, bytes);
  }
  MessageValue value;
  value.definition_ = &definition;
  value.field_ = &field;
  if (field.structure) value.structure_ = *field.structure;
  if (field.count == Count::kOne) {
    if (field.primitive == Primitive::kString) {
      value.count_ = pass_count(bytes);
      value.begin_ = bytes;
      pass(bytes, value.count_);
    } else {
      align(bytes, alignment_of(field.primitive));
      value.begin_ = bytes;
      pass(bytes, bytes_of(field.primitive));
    }
    return value;
  }
  MessageBytes behind = bytes;
  value.count_ = count_of(definition, field, behind);
  const bool is_numbers = !field.structure && field.primitive != Primitive::kString;
  if (is_numbers && value.count_ > 0) align(behind, alignment_of(field.primitive));
  value.begin_ = behind;
  skip_field(definition, field, bytes);
  return value;
}

void MessageValue::fail(const std::string& expected) const {
  const std::string where = field_ == nullptr ? definition_->structures.front().name : field_->name;
  throw BadMessage(fmt::format("a message whose '{}' is not {}", where, expected));
}

bool MessageValue::is_single(bool wants_structure) const {
  if (field_ == nullptr) return wants_structure;
  return field_->count == Count::kOne && field_->structure.has_value() == wants_structure;
}

const MessageValue* MessageValue::find(std::string_view name) const {
  for (const MessageValue& field : fields_) {
    if (field.field_->name == name) return &field;
  }
  return nullptr;
}

const MessageValue& MessageValue::operator[](std::string_view name) const {
  const MessageValue* found = find(name);
  if (found == nullptr) fail(fmt::format("a structure with '{}'", name));
  return *found;
}

double MessageValue::number() const {
  if (!is_single(false) || field_->primitive >= Primitive::kString) fail("a number");
  return double_at(field_->primitive, begin_.bytes.data() + begin_.at, begin_.swap_bytes);
}

std::int64_t MessageValue::integer() const {
  if (!is_single(false) || field_->primitive >= Primitive::kFloat) fail("a whole number");
  const std::byte* at = begin_.bytes.data() + begin_.at;
  if (field_->primitive == Primitive::kInt64 || field_->primitive == Primitive::kUint64) {
    return number_at<std::int64_t>(at, begin_.swap_bytes);
  }
  return static_cast<std::int64_t>(double_at(field_->primitive, at, begin_.swap_bytes));
}

std::string_view MessageValue::text() const {
  if (!is_single(false) || field_->primitive != Primitive::kString) fail("a text");
  std::string_view text(reinterpret_cast<const char*>(begin_.bytes.data()) + begin_.at, count_);
  if (begin_.is_cdr && text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

std::int64_t MessageValue::time_ns() const {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (is_single(true)) {
    const MessageValue* seconds = find("sec");
    const MessageValue* rest = find("nanosec");
    if (seconds == nullptr || rest == nullptr) fail("a time");
    return seconds->integer() * kSecond + rest->integer();
  }
  if (!is_single(false)) fail("a time");
  const std::byte* at = begin_.bytes.data() + begin_.at;
  if (field_->primitive == Primitive::kTime) {
    return number_at<std::uint32_t>(at, begin_.swap_bytes) * kSecond +
           number_at<std::uint32_t>(at + 4, begin_.swap_bytes);
  }
  if (field_->primitive != Primitive::kDuration) fail("a time");
  return number_at<std::int32_t>(at, begin_.swap_bytes) * kSecond +
         number_at<std::int32_t>(at + 4, begin_.swap_bytes);
}

NumberColumn MessageValue::numbers() const {
  const bool is_array = field_ != nullptr && field_->count != Count::kOne && !field_->structure &&
                        field_->primitive < Primitive::kString;
  if (!is_array) fail("an array of numbers");
  return {field_->primitive, count_, begin_.bytes.data() + begin_.at, bytes_of(field_->primitive),
          begin_.swap_bytes};
}

std::span<const std::byte> MessageValue::bytes() const {
  const NumberColumn all = numbers();
  if (all.step != 1) fail("an array of bytes");
  return {all.first, all.count};
}

NumberColumn MessageValue::column(std::string_view name) const {
  const bool is_array = field_ != nullptr && field_->count != Count::kOne && field_->structure;
  if (!is_array) fail("an array of structures");
  const auto& fields = definition_->structures[structure_].fields;
  NumberColumn column;
  column.count = count_;
  column.swap_bytes = begin_.swap_bytes;
  // Where the fields of three structures in a row begin, as if they were there.
  std::vector<std::size_t> begins;
  MessageBytes at = begin_;
  std::size_t wanted = fields.size();
  constexpr std::size_t kTried = 3;
  for (std::size_t repeat = 0; repeat < kTried; ++repeat) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const Field& field = fields[i];
      const bool is_number =
          !field.structure && field.primitive < Primitive::kString && field.count == Count::kOne;
      if (!is_number) fail("an array of structures of numbers");
      if (field.name == name) wanted = i;
      align(at, alignment_of(field.primitive));
      begins.push_back(at.at);
      at.at += bytes_of(field.primitive);
    }
  }
  if (wanted == fields.size()) fail(fmt::format("an array of structures with '{}'", name));
  column.primitive = fields[wanted].primitive;
  column.step = begins[fields.size()] - begins[0];
  for (std::size_t i = fields.size(); i < begins.size(); ++i) {
    if (begins[i] - begins[i - fields.size()] != column.step) {
      fail("an array of structures of one size");
    }
  }
  column.first = begin_.bytes.data() + begins[wanted];
  if (count_ > 0) {
    const std::size_t end =
        begins[wanted] + (count_ - 1) * column.step + bytes_of(column.primitive);
    if (end > begin_.bytes.size()) fail_short(begin_);
  }
  return column;
}

void MessageValue::for_each(const std::function<void(const MessageValue&)>& use) const {
  const bool is_array = field_ != nullptr && field_->count != Count::kOne;
  if (!is_array) fail("an array");
  MessageBytes at = begin_;
  Field one = *field_;
  one.count = Count::kOne;
  for (std::size_t i = 0; i < count_; ++i) use(read_field(*definition_, one, at));
}

MessageReader::MessageReader(MessageDefinition definition, Serialization serialization)
    : definition_(std::make_shared<const MessageDefinition>(std::move(definition))),
      serialization_(serialization) {
  if (serialization == Serialization::kOther) {
    throw BadMessage("messages that are neither ROS 1's nor CDR");
  }
}

MessageValue MessageReader::read(std::span<const std::byte> bytes) const {
  MessageBytes at{bytes, 0, false, false};
  if (serialization_ == Serialization::kCdr) {
    constexpr std::size_t kHead = 4;
    if (bytes.size() < kHead) throw BadMessage("a message shorter than CDR's own header");
    const auto kind = std::to_integer<unsigned>(bytes[1]);
    if (bytes[0] != std::byte{0} || kind > 1) {
      throw BadMessage(
          fmt::format("a message in the representation {:02x} {:02x}, not CDR "
                      "(00 00 or 00 01)",
                      std::to_integer<unsigned>(bytes[0]), kind));
    }
    at = {bytes.subspan(kHead), 0, true, kind == 0};
  }
  return MessageValue::read_structure(*definition_, 0, nullptr, at);
}

}  // namespace traverse::bags
