#include "traverse/evaluation/titles.hpp"

#include <fmt/format.h>

#include "traverse/files/number_text.hpp"

namespace traverse::evaluation {

namespace {

std::string alignment_title(AlignmentMode mode) {
  switch (mode) {
    case AlignmentMode::kNone:
      return "no alignment";
    case AlignmentMode::kOrigin:
      return "aligned at the first pose";
    case AlignmentMode::kSe3:
      return "SE(3) alignment";
    case AlignmentMode::kSim3:
      return "Sim(3) alignment";
    case AlignmentMode::kScale:
      return "scale correction";
  }
  return "unknown";
}

std::string counted(std::size_t count, std::string_view singular) {
  return fmt::format("{} {}", count, files::noun(count, singular));
}

bool has_scale(AlignmentMode mode) {
  return mode == AlignmentMode::kSim3 || mode == AlignmentMode::kScale;
}

}  // namespace

std::string describe(const Association& association) {
  std::string text = fmt::format("{} by {}", counted(association.matches.size(), "pair"),
                                 name_of(association.mode));
  if (association.mode == AssociationMode::kIndex) return text;
  text += fmt::format(", at most {} s apart", association.options.max_time_difference_s);
  if (association.options.time_offset_s != 0) {
    text += fmt::format(", {} s added to the estimate", association.options.time_offset_s);
  }
  return text;
}

std::string describe(const Alignment& alignment, std::size_t matches) {
  std::string text = alignment_title(alignment.mode);
  if (alignment.poses_used > 1 && alignment.poses_used < matches) {
    text += fmt::format(" on the first {} poses", alignment.poses_used);
  }
  const bool scale_is_open = alignment.undetermined == Undetermined::kScale ||
                             alignment.undetermined == Undetermined::kRotationAndScale;
  if (has_scale(alignment.mode) && !scale_is_open) {
    text += fmt::format(", scale {:.6g}", alignment.scale);
  }
  if (alignment.undetermined != Undetermined::kNothing) {
    text += fmt::format(", {} not determined", name_of(alignment.undetermined));
  }
  return text;
}

std::string describe(const RpeOptions& options) {
  return fmt::format("{}, {} pairs of the {}", to_text(options.delta),
                     options.all_pairs ? "all" : "consecutive", name_of(options.pairs_from));
}

std::string title(const Ape& ape, const Comparison& comparison) {
  return fmt::format("APE {}, {}, {}, {}", title_of(ape.relation),
                     describe(comparison.alignment, comparison.association.matches.size()),
                     counted(ape.values.size(), "pair"), kRuleOfApe);
}

std::string title_at_origin(const Ape& ape) {
  return fmt::format("APE {}, {}, {}, {}", title_of(ape.relation),
                     alignment_title(AlignmentMode::kOrigin), counted(ape.values.size(), "pair"),
                     kRuleOfApe);
}

std::string title(const Rpe& rpe, const Comparison& comparison) {
  std::string text =
      fmt::format("RPE {}, {}, {}, {}, {}", title_of(rpe.relation), describe(rpe.options),
                  describe(comparison.alignment, comparison.association.matches.size()),
                  counted(rpe.values.size(), "pair"), kRuleOfRpe);
  if (rpe.dropped_without_motion > 0) {
    text += fmt::format(", {} without motion left out", rpe.dropped_without_motion);
  }
  return text;
}

std::string split_title(const Comparison& comparison) {
  return fmt::format("position error along, across and up the path, {}, {}",
                     describe(comparison.alignment, comparison.association.matches.size()),
                     counted(comparison.split ? comparison.split->poses : 0, "pair"));
}

std::string alternation_note(const Comparison& comparison) {
  if (!comparison.split || !comparison.split->alternates()) return {};
  return fmt::format(
      "About {:.2g} m of the {:.2g} m error along the path (rmse) change from frame to frame and "
      "back: stamps of low resolution or jitter of the reference do that, an estimate hardly.",
      *comparison.split->alternating_m, comparison.split->along.rmse_m);
}

std::string title(const KittiDrift& kitti) {
  return fmt::format(
      "KITTI drift, {} frame, no alignment, {} of {} to {} m, one start every {}, {} s per pose, "
      "{}",
      kitti.frame, counted(kitti.segments.size(), "segment"), kKittiLengths_m.front(),
      kKittiLengths_m.back(), counted(kitti.step, "pose"), kitti.frame_seconds, kRuleOfKittiDrift);
}

std::string sub_trajectories_title(const Comparison& comparison) {
  const double scale = comparison.alignment.scale;
  return fmt::format(
      "relative errors by length, stretches from every pose, at most 20 % off their length along "
      "the reference, {}, {}",
      scale == 1 ? std::string("no alignment")
                 : fmt::format("scale {:.6g}, else no alignment", scale),
      kRuleOfSubTrajectories);
}

std::string path_title(const Comparison& comparison) {
  return fmt::format(
      "path over {}, no alignment; closing error: distance of the last poses where the first "
      "coincide, in % of the reference's path where that is {} m or more",
      counted(comparison.association.matches.size(), "pair"), kLeastPathForPercent_m);
}

std::string title(const Consistency& score) {
  return fmt::format(
      "map consistency, {} points, {} to {} m away, one a {} m voxel, {} queries among {} points "
      "of "
      "{}, neighbours within {} m",
      score.points_are, consistency::kLeastRange_m, consistency::kMostRange_m,
      consistency::kVoxel_m, score.queries, score.points, counted(score.scans, "scan"),
      consistency::kRadius_m);
}

}  // namespace traverse::evaluation
