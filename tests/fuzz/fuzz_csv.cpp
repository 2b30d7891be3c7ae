#include "traverse/pipeline/frame_table.hpp"
#include "traverse/slam/loop.hpp"

#include "fuzz/fuzz_input.hpp"

using namespace traverse;

namespace {

/// A folder of one table, data.csv, from which all sensors are read.
struct Tables {
  Tables() {
    sensors.write("traverse.yaml", R"(csv:
  gyro: {file: data.csv, time: t, columns: x y z}
  accelerometer: {file: data.csv, time: t, columns: x y z}
  gnss: {file: data.csv, time: t, columns: x y z}
  wheels: {file: data.csv, time: t, columns: x y}
)");
    reference.write("traverse.yaml", R"(csv:
  gyro: {file: other.csv, time: t, columns: x y z}
  accelerometer: {file: other.csv, time: t, columns: x y z}
  gnss: {file: data.csv, time: t, columns: x y z, period_s: 0.1}
  reference: {file: data.csv, time: t, columns: x y z qw qx qy qz}
)");
    reference.write("other.csv", "t,x,y,z\n0,0,0,9.8\n1,0,0,9.8\n");
  }

  fuzz::InputFolder sensors;
  fuzz::InputFolder reference;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Tables tables;
  const auto file = tables.sensors.write("data.csv", fuzz::text_of(data, size));
  tables.reference.write("data.csv", fuzz::text_of(data, size));
  fuzz::read_or_refuse([&] { pipeline::FrameTable::read_csv(file); });
  fuzz::read_or_refuse([&] { slam::read_loops(file); });
  fuzz::read_recording(tables.sensors.path());
  fuzz::read_recording(tables.reference.path());
  return 0;
}
