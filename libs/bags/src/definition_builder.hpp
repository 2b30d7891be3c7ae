#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "traverse/bags/message_definition.hpp"

#include "message_type_name.hpp"

namespace traverse::bags {

/// Puts the structures of a definition together, whatever language they are written in.
class DefinitionBuilder {
 public:
  /// A structure as it is written: its fields, each with the name of its type if that is one of the
  /// other structures.
  struct Written {
    std::string name;
    std::vector<std::pair<MessageDefinition::Field, std::string>> fields;
  };

  void add(Written structure);
  /// \throws BadMessage if a type is missing, holds itself or is an array of nothing
  MessageDefinition build(const std::string& type);

 private:
  static constexpr std::size_t kMostStructures = 1000;
  static constexpr std::size_t kDeepest = 30;
  static constexpr std::uint64_t kMostValues = 100'000;  ///< outside arrays, of one message
  static constexpr std::uint64_t kMostValuesAByte = 16;  ///< of a structure in an array

  const Written* find(const std::string& user, const std::string& name) const;
  std::size_t place(const Written& written, std::vector<std::string>& above);

  std::vector<Written> written_;
  std::map<std::string, std::size_t> placed_;
  std::vector<std::uint64_t> values_;  ///< of each structure, counted through those that it holds
  MessageDefinition result_;
};

}  // namespace traverse::bags
