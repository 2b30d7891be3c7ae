// evaluate_two_trajectories ESTIMATE REFERENCE
//
// What `traverse evaluate ESTIMATE --reference REFERENCE --align se3 --rpe 10f` computes, for a
// program that goes on with the figures. Files are TUM, KITTI or EuRoC.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/evaluate.hpp"

int main(int argc, char** argv) {
  namespace evaluation = traverse::evaluation;
  using traverse::dataset::read_trajectory;
  using traverse::dataset::TrajectoryFormat;
  if (argc != 3) {
    std::fprintf(stderr, "usage: evaluate_two_trajectories ESTIMATE REFERENCE\n");
    return 2;
  }
  try {
    const auto estimate = read_trajectory(argv[1], TrajectoryFormat::kAuto);
    const auto reference = read_trajectory(argv[2], TrajectoryFormat::kAuto);

    evaluation::EvaluationOptions options;
    options.alignment.mode = evaluation::AlignmentMode::kSe3;
    evaluation::RpeOptions ten_frames;
    ten_frames.delta = {10, evaluation::DeltaUnit::kFrames};
    options.rpe.push_back(ten_frames);
    const auto result = evaluation::evaluate(estimate, reference, options);

    const evaluation::Comparison& comparison = *result.comparison;
    std::printf("%zu of %zu poses have a partner\n", comparison.association.matches.size(),
                estimate.size());
    for (const evaluation::Ape& ape : comparison.ape) {
      std::printf("APE rmse %.6f median %.6f max %.6f %s\n", ape.statistics.rmse,
                  ape.statistics.median, ape.statistics.max,
                  evaluation::unit_of(ape.relation).data());
    }
    for (const evaluation::Rpe& rpe : comparison.rpe) {
      std::printf("RPE over 10 frames rmse %.6f %s\n", rpe.statistics.rmse,
                  evaluation::unit_of(rpe.relation).data());
    }
  } catch (const std::exception& error) {  // says which file, which line and what is wrong there
    std::fprintf(stderr, "evaluate_two_trajectories: %s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
