// your_own_odometry RECORDING RUN [PRESET.yaml]
//
// Runs an odometry that Traverse does not have through Traverse's run loop: it reads every
// recording that Traverse reads, and leaves a run folder with trajectory, map, evaluation and
// report that `traverse compare` and all other commands take.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/pipeline/odometry_kind.hpp"
#include "traverse/pipeline/run.hpp"
#include "traverse/report/run_report.hpp"

#include "nearest_point_odometry.hpp"

int main(int argc, char** argv) {
  namespace pipeline = traverse::pipeline;
  if (argc < 3 || argc > 4) {
    std::fprintf(stderr, "usage: your_own_odometry RECORDING RUN [PRESET.yaml]\n");
    return 2;
  }
  try {
    // From here on a preset may say `estimator: nearest_points`.
    pipeline::register_odometry(
        "nearest_points", pipeline::odometry_kind<NearestPointOdometry, NearestPointOptions>());

    pipeline::PresetRequest request;
    request.name = argc > 3 ? argv[3] : "nearest_points.yaml";
    const pipeline::Preset preset = pipeline::load_preset(request, TRAVERSE_SHARE);

    traverse::dataset::OpenOptions open;
    open.share_folder = TRAVERSE_SHARE;
    const auto recording = traverse::dataset::open_recording(argv[1], open);

    const std::filesystem::path folder = argv[2];
    if (std::filesystem::exists(folder)) {
      throw std::runtime_error(folder.string() + " is there already; name a new folder");
    }
    pipeline::Pipeline estimation = pipeline::make_pipeline(preset, recording->info(), 1);
    pipeline::RunOptions options;
    options.command.assign(argv, argv + argc);
    const pipeline::RunRecord record =
        pipeline::run(*recording, estimation, {folder}, options, pipeline::RunObserver{});
    if (record.status != pipeline::RunStatus::kOk) throw std::runtime_error(record.reason);
    traverse::report::write_run_report(folder, TRAVERSE_TEMPLATES);
    std::printf("%zu frames of %zu, %s\n", record.frames_used, record.frames_read,
                (folder / "report.html").c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "your_own_odometry: %s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
