#pragma once

#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "traverse/bags/message_container.hpp"
#include "traverse/bags/message_value.hpp"
#include "traverse/files/input_error.hpp"

#include "fuzz/input_in_memory.hpp"

/// What the fuzz targets of containers and messages share.
namespace traverse::fuzz {

/// Looks at every value of a structure, by what its definition says that it is: what is refused
/// takes the fuzzer a hundred times as long as what is read.
inline void walk(const bags::MessageValue& value, const bags::MessageDefinition& definition,
                 std::size_t structure) {
  using bags::MessageDefinition;
  constexpr std::size_t kMost = 8;
  for (const MessageDefinition::Field& field : definition.structures[structure].fields) {
    const bags::MessageValue& inner = value[field.name];
    const bool is_text = field.primitive == bags::Primitive::kString;
    if (&inner != value.find(field.name)) std::abort();
    if (field.count == MessageDefinition::Count::kOne) {
      if (field.structure) {
        walk(inner, definition, *field.structure);
      } else if (is_text) {
        static_cast<void>(std::string(inner.text()));
      } else if (field.primitive > bags::Primitive::kString) {
        static_cast<void>(inner.time_ns());
      } else {
        static_cast<void>(inner.number());
      }
      continue;
    }
    if (field.structure || is_text) {
      std::size_t seen = 0;
      inner.for_each([&](const bags::MessageValue& one) {
        if (++seen > kMost) return;
        if (field.structure) {
          walk(one, definition, *field.structure);
        } else {
          static_cast<void>(std::string(one.text()));
        }
      });
    }
    if (field.structure) {
      const auto& first = definition.structures[*field.structure].fields.front();
      try {
        const bags::NumberColumn numbers = inner.column(first.name);
        if (numbers.count > 0) static_cast<void>(numbers[numbers.count - 1]);
      } catch (const bags::BadMessage&) {  // of structures of several sizes
      }
    } else if (field.primitive < bags::Primitive::kString) {
      const bags::NumberColumn numbers = inner.numbers();
      double sum = 0;
      for (std::size_t i = 0; i < numbers.count; ++i) sum += numbers[i];
      static_cast<void>(sum);
    }
  }
}

/// Opens a container and reads every message of it by its definition.
inline void read_container(const std::function<std::unique_ptr<bags::MessageContainer>()>& open) {
  try {
    const auto container = open();
    const bags::Contents& contents = container->contents();
    std::vector<std::optional<bags::MessageReader>> readers(contents.channels.size());
    for (std::size_t i = 0; i < readers.size(); ++i) {
      try {
        readers[i].emplace(bags::definition_of(contents.channels[i]),
                           contents.channels[i].serialization);
      } catch (const bags::BadMessage&) {
      }
    }
    std::vector<std::size_t> all(readers.size());
    std::iota(all.begin(), all.end(), 0U);
    container->begin(all);
    while (const auto message = container->next()) {
      if (!readers[message->channel]) continue;
      try {
        const bags::MessageReader& reader = *readers[message->channel];
        walk(reader.read(message->bytes), reader.definition(), 0);
      } catch (const bags::BadMessage&) {
      }
    }
    static_cast<void>(container->losses());
  } catch (const files::InputError&) {
  }
}

}  // namespace traverse::fuzz
