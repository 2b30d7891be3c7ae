#include "traverse/bags/message_definition.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "definition_builder.hpp"

namespace traverse::bags {

namespace {

constexpr std::array<std::pair<std::string_view, Primitive>, 19> kMsgNames{
    {{"bool", Primitive::kBool},
     {"boolean", Primitive::kBool},
     {"int8", Primitive::kInt8},
     {"uint8", Primitive::kUint8},
     {"byte", Primitive::kUint8},
     {"char", Primitive::kUint8},
     {"octet", Primitive::kUint8},
     {"int16", Primitive::kInt16},
     {"uint16", Primitive::kUint16},
     {"int32", Primitive::kInt32},
     {"uint32", Primitive::kUint32},
     {"int64", Primitive::kInt64},
     {"uint64", Primitive::kUint64},
     {"float32", Primitive::kFloat},
     {"float64", Primitive::kDouble},
     {"string", Primitive::kString},
     {"time", Primitive::kTime},
     {"duration", Primitive::kDuration},
     {"double", Primitive::kDouble}}};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::uint64_t whole_number(std::string_view text, std::string_view line) {
  std::uint64_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size()) {
    throw BadMessage(fmt::format("a definition with the line '{}'", line));
  }
  return value;
}

/// "float64[36] covariance" into the fields of `structure`.
void add_msg_line(std::string_view line, DefinitionBuilder::Written& structure,
                  Serialization serialization) {
  const std::string_view whole = line;
  // A '#' in a constant or default of a string ends nothing that matters.
  line = trimmed(line.substr(0, line.find('#')));
  if (line.empty()) return;
  const auto blank = line.find_first_of(" \t");
  if (blank == std::string_view::npos) {
    throw BadMessage(fmt::format("a definition with the line '{}'", whole));
  }
  std::string_view type = line.substr(0, blank);
  std::string_view rest = trimmed(line.substr(blank));
  const auto name_end = rest.find_first_of(" \t=");
  const std::string_view name = rest.substr(0, name_end);
  const std::string_view behind =
      name_end == std::string_view::npos ? "" : trimmed(rest.substr(name_end));
  if (behind.starts_with('=')) return;  // a constant

  MessageDefinition::Field field;
  field.name = std::string(name);
  if (const auto bracket = type.find('['); bracket != std::string_view::npos) {
    const std::string_view size = type.substr(bracket + 1, type.find(']') - bracket - 1);
    type = type.substr(0, bracket);
    const bool is_many = size.empty() || size.starts_with("<=");
    field.count = is_many ? MessageDefinition::Count::kMany : MessageDefinition::Count::kFixed;
    if (!is_many) field.fixed = whole_number(size, whole);
  }
  if (const auto bound = type.find("<="); bound != std::string_view::npos) {
    type = type.substr(0, bound);
  }
  if (serialization == Serialization::kRos1 && type == "byte") {
    field.primitive = Primitive::kInt8;
    structure.fields.emplace_back(std::move(field), "");
    return;
  }
  const bool is_ros1 = serialization == Serialization::kRos1;
  for (const auto& [known, primitive] : kMsgNames) {
    const bool is_time = primitive == Primitive::kTime || primitive == Primitive::kDuration;
    if (known != type || (is_time && !is_ros1)) continue;
    field.primitive = primitive;
    structure.fields.emplace_back(std::move(field), "");
    return;
  }
  structure.fields.emplace_back(std::move(field), std::string(type));
}

}  // namespace

std::size_t bytes_of(Primitive primitive) {
  constexpr std::array<std::size_t, 14> kBytes{1, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8, 0, 8, 8};
  return kBytes.at(static_cast<std::size_t>(primitive));
}

void DefinitionBuilder::add(Written structure) {
  if (written_.size() >= kMostStructures) throw BadMessage("a definition of too many types");
  written_.push_back(std::move(structure));
}

const DefinitionBuilder::Written* DefinitionBuilder::find(const std::string& user,
                                                          const std::string& name) const {
  const auto called = [&](const std::string& wanted) {
    const auto known = std::find_if(written_.begin(), written_.end(),
                                    [&](const Written& other) { return other.name == wanted; });
    return known == written_.end() ? nullptr : &*known;
  };
  if (name.find('/') != std::string::npos) return called(plain_type_name(name));
  if (name == "Header") return called("std_msgs/Header");
  const Written* own = called(user.substr(0, user.find('/')) + "/" + name);
  if (own != nullptr) return own;
  const auto any = std::find_if(written_.begin(), written_.end(), [&](const Written& other) {
    return other.name.substr(other.name.find('/') + 1) == name;
  });
  return any == written_.end() ? nullptr : &*any;
}

std::size_t DefinitionBuilder::place(const Written& written, std::vector<std::string>& above) {
  if (std::count(above.begin(), above.end(), written.name) > 0 || above.size() > kDeepest) {
    throw BadMessage(fmt::format("a definition in which {} holds itself", written.name));
  }
  if (const auto known = placed_.find(written.name); known != placed_.end()) return known->second;
  above.push_back(written.name);
  const std::size_t index = result_.structures.size();
  result_.structures.push_back({written.name, {}, 0});
  values_.push_back(0);
  placed_[written.name] = index;
  std::vector<MessageDefinition::Field> fields;
  std::uint64_t least = 0;
  std::uint64_t values = 1;
  for (const auto& [field, type] : written.fields) {
    MessageDefinition::Field placed = field;
    std::uint64_t one = std::max<std::uint64_t>(bytes_of(field.primitive), 1);
    if (field.primitive == Primitive::kString) one = 4;
    if (!type.empty()) {
      const Written* used = find(written.name, type);
      if (used == nullptr) {
        throw BadMessage(fmt::format("a definition of {} without that of {}", written.name, type));
      }
      placed.structure = place(*used, above);
      one = result_.structures[*placed.structure].least_bytes;
      values += values_[*placed.structure];
      if (one == 0 && placed.count != MessageDefinition::Count::kOne) {
        throw BadMessage(fmt::format("a definition with an array of {}, which is empty", type));
      }
      // Reading takes time by the values, and their number follows from the bytes.
      if (placed.count != MessageDefinition::Count::kOne &&
          values_[*placed.structure] / kMostValuesAByte > one) {
        throw BadMessage(
            fmt::format("a definition with an array of {}, most of which is empty", type));
      }
    }
    const std::uint64_t times = placed.count == MessageDefinition::Count::kFixed ? placed.fixed : 1;
    std::uint64_t all = placed.count == MessageDefinition::Count::kMany ? 4 : 0;
    if (placed.count != MessageDefinition::Count::kMany &&
        __builtin_mul_overflow(one, times, &all)) {
      all = std::numeric_limits<std::uint64_t>::max();
    }
    if (__builtin_add_overflow(least, all, &least))
      least = std::numeric_limits<std::uint64_t>::max();
    fields.push_back(std::move(placed));
    if (++values > kMostValues) throw BadMessage("a definition of too many values");
  }
  values_[index] = values;
  result_.structures[index].fields = std::move(fields);
  result_.structures[index].least_bytes = least;
  above.pop_back();
  return index;
}

MessageDefinition DefinitionBuilder::build(const std::string& type) {
  const Written* root = find(type, type);
  if (root == nullptr) throw BadMessage(fmt::format("a definition without {}", type));
  std::vector<std::string> above;
  place(*root, above);
  return std::move(result_);
}

MessageDefinition parse_msg_definition(std::string_view type, std::string_view text,
                                       Serialization serialization) {
  DefinitionBuilder builder;
  DefinitionBuilder::Written structure{std::string(type), {}};
  const auto finish = [&] {
    // ROS 2 gives a structure without fields a byte.
    if (structure.fields.empty() && serialization == Serialization::kCdr) {
      structure.fields.emplace_back(
          MessageDefinition::Field{
              "structure_needs_at_least_one_member", Primitive::kUint8, {}, {}, 0},
          "");
    }
    builder.add(std::exchange(structure, {}));
  };
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (line.starts_with("====")) continue;
    if (line.starts_with("MSG:")) {
      finish();
      structure.name = plain_type_name(trimmed(line.substr(4)));
      continue;
    }
    add_msg_line(line, structure, serialization);
  }
  finish();
  return builder.build(std::string(type));
}

MessageDefinition definition_of(const Channel& channel) {
  switch (channel.definition_form) {
    case DefinitionForm::kMsg:
      return parse_msg_definition(channel.type, channel.definition, channel.serialization);
    case DefinitionForm::kIdl:
      return parse_idl_definition(channel.type, channel.definition);
    case DefinitionForm::kNone:
      break;
  }
  const std::string known = known_definition(channel.type);
  if (known.empty()) throw BadMessage("no definition of " + channel.type + " is stored");
  return parse_msg_definition(channel.type, known, channel.serialization);
}

}  // namespace traverse::bags
