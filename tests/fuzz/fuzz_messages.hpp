#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

#include "traverse/bags/message_container.hpp"
#include "traverse/bags/message_value.hpp"
#include "traverse/files/input_error.hpp"

/// What the fuzz targets of containers and messages share.
namespace traverse::fuzz {

/// A file without a place on disk that holds the fuzzer's bytes.
class InputInMemory {
 public:
  InputInMemory(const std::uint8_t* data, std::size_t size)
      : descriptor_(::memfd_create("input", 0)) {
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, data, size);
      if (written <= 0) break;
      data += written;
      size -= static_cast<std::size_t>(written);
    }
  }
  ~InputInMemory() { ::close(descriptor_); }
  InputInMemory(const InputInMemory&) = delete;
  InputInMemory& operator=(const InputInMemory&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Looks at every value, as far as there is one.
inline void walk(const bags::MessageValue& value) {
  constexpr std::size_t kMost = 1000;
  const auto try_to = [](const auto& look) {
    try {
      look();
    } catch (const bags::BadMessage&) {
    }
  };
  try_to([&] { static_cast<void>(value.number()); });
  try_to([&] { static_cast<void>(value.text().size()); });
  try_to([&] { static_cast<void>(value.time_ns()); });
  try_to([&] {
    const bags::NumberColumn numbers = value.numbers();
    double sum = 0;
    for (std::size_t i = 0; i < numbers.count; ++i) sum += numbers[i];
    static_cast<void>(sum);
  });
  for (const char* name : {"x", "offset_time", "line"}) {
    try_to([&] {
      const bags::NumberColumn numbers = value.column(name);
      if (numbers.count > 0) static_cast<void>(numbers[numbers.count - 1]);
    });
  }
  try_to([&] {
    std::size_t seen = 0;
    value.for_each([&](const bags::MessageValue& one) {
      if (++seen < kMost) walk(one);
    });
  });
  for (const char* name : {"header", "stamp", "frame_id", "fields", "data", "transforms", "points",
                           "pose", "orientation", "x", "w"}) {
    if (const bags::MessageValue* field = value.find(name)) walk(*field);
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
        walk(readers[message->channel]->read(message->bytes));
      } catch (const bags::BadMessage&) {
      }
    }
    static_cast<void>(container->losses());
  } catch (const files::InputError&) {
  }
}

}  // namespace traverse::fuzz
