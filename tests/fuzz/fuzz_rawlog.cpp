#include "fuzz/fuzz_input.hpp"

using namespace traverse;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  fuzz::read_recording(folder.write("fuzzed.rawlog", fuzz::text_of(data, size)));
  return 0;
}
