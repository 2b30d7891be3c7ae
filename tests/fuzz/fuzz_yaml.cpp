#include "traverse/config/document.hpp"
#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/registry.hpp"

#include "fuzz/fuzz_input.hpp"

using namespace traverse;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  static const fuzz::InputFolder scans;
  static const auto cloud = scans.write("0.pcd", R"(VERSION 0.7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH 1
HEIGHT 1
POINTS 1
DATA ascii
1 2 3
)");
  const auto file = folder.write("fuzzed.yaml", fuzz::text_of(data, size));
  fuzz::read_or_refuse([&] { config::Document::load(file).leaves(); });
  fuzz::read_or_refuse([&] {
    const auto preset = pipeline::load_preset({file.string(), {}, {}}, TRAVERSE_SHARE_DIR);
    pipeline::resolve_settings(preset);
  });
  fuzz::read_recording(cloud.parent_path(), {file, {}, TRAVERSE_SHARE_DIR});
  return 0;
}
