#include "traverse/dataset/point_cloud_file.hpp"

#include "fuzz/fuzz_input.hpp"

using namespace traverse;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const auto file = folder.write("0.ply", fuzz::text_of(data, size));
  fuzz::read_or_refuse([&] { dataset::read_point_cloud(file); });
  fuzz::read_recording(folder.path());  // the cloud as a scan
  return 0;
}
