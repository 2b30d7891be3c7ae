#include "fuzz/fuzz_input.hpp"

using namespace traverse;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const auto log = folder.write("log.txt", fuzz::text_of(data, size));
  fuzz::read_recording(log);
  fuzz::read_recording(log,
                       {{},
                        {"log.angular_rate=deg", "log.pulses=interval", "log.time_unit_s=1e-3"},
                        TRAVERSE_SHARE_DIR});
  return 0;
}
