#include <sstream>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/dataset/trajectory_streams.hpp"

#include "fuzz/fuzz_input.hpp"

using namespace traverse;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const auto file = folder.write("poses.txt", fuzz::text_of(data, size));
  for (const auto& [name, format] : dataset::kTrajectoryFormatNames) {
    fuzz::read_or_refuse([&, as = format] {
      const geometry::Trajectory poses = dataset::read_trajectory(file, as);
      // What can be read can be written, and read again.
      std::ostringstream text;
      dataset::write_kitti(text, poses);
      dataset::read_trajectory(folder.write("again.txt", text.str()),
                               dataset::TrajectoryFormat::kKitti);
      if (!poses.is_stamped()) return;
      text.str("");
      dataset::write_tum(text, poses);
      dataset::read_trajectory(folder.write("again.txt", text.str()),
                               dataset::TrajectoryFormat::kTum);
    });
  }
  return 0;
}
