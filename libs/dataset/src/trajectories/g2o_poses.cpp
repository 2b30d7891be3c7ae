#include "trajectories/g2o_poses.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

#include "trajectories/pose_sequence.hpp"

namespace traverse::dataset {

namespace {

constexpr std::string_view kVertex = "VERTEX_SE3:QUAT";
constexpr std::array<std::string_view, 4> kBeginnings{"VERTEX_", "EDGE_", "PARAMS_", "FIX "};

/// GTSAM writes the letter of a key into the highest byte of the id.
std::size_t without_letter(std::int64_t id) {
  constexpr std::int64_t kNumber = (std::int64_t{1} << 56) - 1;
  return static_cast<std::size_t>(id & kNumber);
}

}  // namespace

bool is_g2o(std::string_view line) {
  return std::any_of(kBeginnings.begin(), kBeginnings.end(),
                     [&](std::string_view beginning) { return line.starts_with(beginning); });
}

void read_g2o(files::LineReader& reader, const PoseTaker& take, TrajectoryReading& reading) {
  constexpr std::size_t kWords = 9;
  struct Vertex {
    std::size_t id;
    geometry::Pose3 pose;
  };
  std::vector<Vertex> vertices;
  std::size_t id = 0;
  const PoseTaker keep = [&](const std::optional<geometry::Stamp>&, const geometry::Pose3& pose) {
    vertices.push_back(Vertex{id, pose});
  };
  PosesInOrder poses(keep, false);
  while (reader.next()) {
    const auto words = files::split_words(reader.line());
    if (words[0].starts_with("VERTEX_SE2")) {
      throw reader.error("vertices VERTEX_SE3:QUAT, whose poses are in space",
                         files::in_quotes(words[0]) + ", which are in the plane");
    }
    if (words[0] != kVertex) continue;
    if (words.size() != kWords) {
      throw reader.error("VERTEX_SE3:QUAT id x y z qx qy qz qw",
                         fmt::format("{} words", words.size()));
    }
    const auto number = files::parse_integer(words[1]);
    if (!number || *number < 0) {
      throw reader.error("an id, a whole number from 0 on", files::in_quotes(words[1]));
    }
    id = without_letter(*number);
    std::array<double, 7> values{};
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = finite_number(reader, words[k + 2]);
    }
    poses.add(reader, std::nullopt, {values[0], values[1], values[2]},
              {values[3], values[4], values[5], values[6]});
  }
  std::stable_sort(vertices.begin(), vertices.end(),
                   [](const Vertex& a, const Vertex& b) { return a.id < b.id; });
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (i > 0 && vertices[i].id == vertices[i - 1].id) {
      throw reader.error("vertices of different ids",
                         fmt::format("two with the id {}", vertices[i].id));
    }
    reading.frame_numbers.push_back(vertices[i].id);
    take(std::nullopt, vertices[i].pose);
  }
  reading.notes = poses.notes();
  reading.notes.emplace_back("a pose graph has no stamps: the ids are taken for numbers of scans");
}

}  // namespace traverse::dataset
