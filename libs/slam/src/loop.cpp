#include "traverse/slam/loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::slam {

namespace {

constexpr std::array<std::pair<LoopSource, std::string_view>, 2> kSources{
    {{LoopSource::kPosition, "position"}, {LoopSource::kAppearance, "appearance"}}};

constexpr std::array<std::pair<LoopVerdict, std::string_view>, 8> kVerdicts{
    {{LoopVerdict::kAccepted, "accepted"},
     {LoopVerdict::kNotRegistered, "not registered"},
     {LoopVerdict::kDegenerate, "degenerate"},
     {LoopVerdict::kLittleOverlap, "little overlap"},
     {LoopVerdict::kResidual, "residual"},
     {LoopVerdict::kOdometry, "contradicts odometry"},
     {LoopVerdict::kAlone, "alone"},
     {LoopVerdict::kOutvoted, "outvoted"}}};

template <typename Enum, std::size_t N>
std::string_view name_in(const std::array<std::pair<Enum, std::string_view>, N>& names,
                         Enum value) {
  for (const auto& [named, name] : names) {
    if (named == value) return name;
  }
  return {};
}

/// A loop as its row has it: the pose as seven numbers.
struct Row {
  Loop loop;
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// The columns, named in this one place. \tparam AnyRow Row or const Row
template <typename AnyRow, typename Visit>
void for_each_column(AnyRow& row, const Visit& visit) {
  auto& loop = row.loop;
  visit("keyframe", loop.keyframe);
  visit("stamp_s", loop.stamp);
  visit("candidate", loop.candidate);
  visit("candidate_stamp_s", loop.candidate_stamp);
  visit("source", loop.source);
  visit("verdict", loop.verdict);
  visit("overlap", loop.overlap);
  visit("submap_overlap", loop.submap_overlap);
  visit("residual_rms_m", loop.residual_rms_m);
  visit("weakest_eigenvalue", loop.weakest_eigenvalue);
  visit("odometry_chi2", loop.odometry_chi2);
  visit("prediction_sigma_m", loop.prediction_sigma_m);
  visit("correction_m", loop.correction_m);
  visit("descriptor_distance", loop.descriptor_distance);
  visit("graph_chi2", loop.graph_chi2);
  visit("weight", loop.weight);
  visit("x_m", row.t.x());
  visit("y_m", row.t.y());
  visit("z_m", row.t.z());
  visit("qx", row.q.x());
  visit("qy", row.q.y());
  visit("qz", row.q.z());
  visit("qw", row.q.w());
}

std::string to_cell(double value) { return files::to_text(value); }
std::string to_cell(std::size_t value) { return fmt::format("{}", value); }
std::string to_cell(geometry::Stamp value) { return geometry::to_text(value); }
std::string to_cell(LoopSource value) { return std::string(name_of(value)); }
std::string to_cell(LoopVerdict value) { return std::string(name_of(value)); }

bool from_cell(std::string_view cell, double& value) {
  const auto parsed = files::parse_double(cell);
  if (parsed) value = *parsed;
  return parsed.has_value();
}
bool from_cell(std::string_view cell, std::size_t& value) {
  const auto parsed = files::parse_integer(cell);
  if (!parsed || *parsed < 0) return false;
  value = static_cast<std::size_t>(*parsed);
  return true;
}
bool from_cell(std::string_view cell, geometry::Stamp& value) {
  const auto parsed = geometry::parse_stamp_seconds(cell);
  if (parsed) value = *parsed;
  return parsed.has_value();
}
template <typename Enum, std::size_t N>
bool named(const std::array<std::pair<Enum, std::string_view>, N>& names, std::string_view cell,
           Enum& value) {
  for (const auto& [named_value, name] : names) {
    if (name != cell) continue;
    value = named_value;
    return true;
  }
  return false;
}
bool from_cell(std::string_view cell, LoopSource& value) { return named(kSources, cell, value); }
bool from_cell(std::string_view cell, LoopVerdict& value) { return named(kVerdicts, cell, value); }

std::vector<std::string> column_names() {
  std::vector<std::string> names;
  const Row none;
  for_each_column(none, [&](const char* name, const auto&) { names.emplace_back(name); });
  return names;
}

}  // namespace

std::string_view name_of(LoopSource source) { return name_in(kSources, source); }
std::string_view name_of(LoopVerdict verdict) { return name_in(kVerdicts, verdict); }

void write_loops(const std::filesystem::path& file, std::span<const Loop> loops) {
  files::AtomicFile target(file);
  target.stream() << fmt::format("{}\n", fmt::join(column_names(), ","));
  for (const Loop& loop : loops) {
    const Row row{loop, loop.T_candidate_keyframe.translation,
                  loop.T_candidate_keyframe.quaternion()};
    std::vector<std::string> cells;
    for_each_column(row, [&](const char*, const auto& value) { cells.push_back(to_cell(value)); });
    target.stream() << fmt::format("{}\n", fmt::join(cells, ","));
  }
  target.commit();
}

std::vector<Loop> read_loops(const std::filesystem::path& file) {
  files::LineReader reader(file);
  if (!reader.next()) throw reader.error("a header line", "an empty file");
  const std::vector<std::string> names = column_names();
  const auto head = files::split_cells(reader.line(), ',');
  if (!std::equal(names.begin(), names.end(), head.begin(), head.end())) {
    throw reader.error(
        fmt::format("the {} columns {}, ... {}", names.size(), names.front(), names.back()));
  }
  std::vector<Loop> loops;
  while (reader.next()) {
    const std::vector<std::string_view> cells = files::split_cells(reader.line(), ',');
    Row row;
    std::size_t column = 0;
    for_each_column(row, [&](const char* name, auto& value) {
      if (column >= cells.size()) throw reader.error(fmt::format("a value of {}", name), "no more");
      if (!from_cell(cells[column], value)) {
        throw reader.error(fmt::format("a value of {}", name), files::in_quotes(cells[column]));
      }
      ++column;
    });
    row.loop.T_candidate_keyframe = geometry::Pose3::from_quaternion(row.q, row.t);
    loops.push_back(row.loop);
  }
  return loops;
}

}  // namespace traverse::slam
