#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/evaluation/poses.hpp"

namespace traverse::evaluation {

enum class DeltaUnit { kFrames, kMetres, kDegrees, kRadians };

/// The names that the command line and evaluation.json use: "10f", "100m", "5deg", "0.1rad".
inline constexpr std::array<std::pair<std::string_view, DeltaUnit>, 4> kDeltaUnitNames{
    {{"f", DeltaUnit::kFrames},
     {"m", DeltaUnit::kMetres},
     {"deg", DeltaUnit::kDegrees},
     {"rad", DeltaUnit::kRadians}}};
std::string_view name_of(DeltaUnit unit);

/// How far apart the two poses of a pair are.
struct Delta {
  double value = 1;  ///< a whole number of frames from 1; metres above 0; an angle up to pi
  DeltaUnit unit = DeltaUnit::kFrames;

  bool is_valid() const;
};

/// A number and its unit without blank, nothing if it is not that or not valid.
std::optional<Delta> parse_delta(std::string_view text);
std::string to_text(const Delta& delta);  ///< "10 frames", "100 m", "5 deg"

struct IndexPair {
  std::size_t from = 0;
  std::size_t to = 0;

  bool operator==(const IndexPair&) const = default;
};

/// Pairs of poses `delta` apart, none if there is no such pair.
///
/// Consecutive pairs follow one another. Frames: (0, d), (d, 2d), ... Metres: the path is walked,
/// an index is recorded where at least `delta` has accumulated since the last one, and successive
/// recorded indices are pairs; as in evo the stretch before the first one is none. Angles: the
/// same with the rotation from pose to pose, but here index 0 begins the first pair.
///
/// All pairs may overlap. Frames: every (i, i + d). Metres: for each i the later pose whose
/// distance along the path is nearest to `delta`, if within a tenth of it. Angles: every two poses
/// whose directions differ by `delta` to a tenth of it.
///
/// \throws std::invalid_argument if `delta` is not valid.
std::vector<IndexPair> select_pairs(const Poses& poses, const Delta& delta, bool all_pairs);

}  // namespace traverse::evaluation
