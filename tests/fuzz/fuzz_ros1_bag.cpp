#include "fuzz/fuzz_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const traverse::fuzz::InputInMemory input(data, size);
  traverse::fuzz::read_container([&] { return traverse::bags::open_ros1_bag(input.path()); });
  return 0;
}
