#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <mrpt/serialization/CArchive.h>

namespace traverse::testing {

using Fill = std::function<void(mrpt::serialization::CArchive&)>;

/// An object: the length of its name with bit 7 set, the name, the version, what it holds, the end.
inline void write_object(mrpt::serialization::CArchive& archive, const std::string& name,
                         std::uint8_t version, const Fill& fill) {
  constexpr std::uint8_t kEndOfObject = 0x88;
  archive << static_cast<std::uint8_t>(name.size() | 0x80U);
  archive.WriteBuffer(name.data(), name.size());
  archive << version;
  fill(archive);
  archive << kEndOfObject;
}

}  // namespace traverse::testing
