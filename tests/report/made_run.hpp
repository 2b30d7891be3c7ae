#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_record.hpp"

namespace traverse::report {

inline constexpr const char* kEvil = "=<script>alert('x')</script> & \"quoted\"";
inline constexpr const char* kTemplates = TRAVERSE_SOURCE_DIR "/reports/templates";

struct MadeRunOptions {
  double error_m = 0.1;  ///< sideways, coming and going
  bool with_reference = true;
  std::size_t frames = 60;
  std::size_t map_points = 3;
  std::string name = kEvil;
};

/// Writes the folder of a run of a drive along a curve, made by hand, with every text that comes
/// from outside trying to be a script.
inline void make_run(const std::filesystem::path& folder, const MadeRunOptions& options = {}) {
  const pipeline::RunFolder files{folder};
  const auto degenerate = [](std::size_t i) { return i >= 20 && i < 25 ? 1.0 : 0.0; };
  geometry::Trajectory estimate;
  geometry::Trajectory reference;
  pipeline::FrameTable frames({"frame", "stamp_s", "registered", "degenerate_directions",
                               "residual_rms_m", "inlier_share", "line_matches", "plane_matches",
                               "eigenvalue_1", "solve_ms", "total_ms"});
  for (std::size_t i = 0; i < options.frames; ++i) {
    const auto k = static_cast<double>(i);
    geometry::Pose3 pose;
    pose.translation = {2.0 * k, 60 * std::sin(k / 60), 0};
    const auto stamp = geometry::Stamp::from_seconds(0.1 * k);
    reference.push_back(stamp, pose);
    pose.translation.y() +=
        options.error_m * std::sin(0.5 * k) * std::exp(-std::pow((k - 40) / 12, 2));
    estimate.push_back(stamp, pose);
    frames.add_row({k, 0.1 * k, i == 0 ? 0.0 : 1.0, degenerate(i), 0.05 + 0.01 * std::sin(k), 0.9,
                    100, 500, 0.2, 4, 9 + std::sin(k)});
  }
  dataset::write_tum(files.trajectory(), estimate);
  frames.write_csv(files.frames());
  evaluation::Evaluation evaluation = evaluation::evaluate(estimate);
  if (options.with_reference) {
    dataset::write_tum(files.reference(), reference);
    evaluation = evaluation::evaluate(estimate, reference, evaluation::run_evaluation_options());
  }
  files::write_text(files.evaluation(), evaluation::to_json(evaluation));

  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
  std::vector<float> intensity;
  for (std::size_t i = 0; i < options.map_points; ++i) {  // a corridor along the way
    const double along =
        static_cast<double>(i * options.frames) / static_cast<double>(options.map_points);
    const double angle = 2.399963 * static_cast<double>(i);  // the golden angle
    x.push_back(static_cast<float>(2 * along));
    y.push_back(static_cast<float>(60 * std::sin(along / 60) + 12 * std::cos(angle)));
    z.push_back(static_cast<float>(6 * std::sin(angle)));
    intensity.push_back(static_cast<float>(i % 100));
  }
  dataset::PointCloud map;
  map.add("x", x);
  map.add("y", y);
  map.add("z", z);
  map.add("intensity", intensity);
  dataset::write_ply(files.map_points(), map);

  pipeline::RunRecord record;
  record.status = pipeline::RunStatus::kOk;
  record.pipeline = "floam";
  record.pipeline_description = kEvil;
  record.recording.name = options.name;
  record.recording.path = kEvil;
  record.recording.facts.push_back({kEvil, kEvil, kEvil});
  record.settings.push_back({{"solver.huber_m", 0.2, kEvil, ""}, 0.1});
  record.skipped.add(kEvil, kEvil);
  record.command = {"traverse", kEvil};
  record.frames_used = options.frames;
  record.map_points = options.map_points;
  record.map_voxel_m = 0.2;
  record.started_utc = "2026-01-02T03:04:05Z";
  pipeline::summarise_timing(frames, record);
  files::write_text(files.record(), to_json(record, pipeline::build_info(), pipeline::host_info()));
}

}  // namespace traverse::report
