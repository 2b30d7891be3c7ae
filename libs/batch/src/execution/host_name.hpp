#pragma once

#include <array>
#include <string>
#include <unistd.h>

namespace traverse::batch {

inline std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace traverse::batch
