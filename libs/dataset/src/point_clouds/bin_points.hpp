#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

class Statements;

/// The numbers of a file without a header: all of one type, or NCLT's eight bytes a point.
enum class BinType { kAuto, kFloat32, kFloat64, kNclt };

/// What is stated of such files.
struct BinStatements {
  std::string columns;  ///< names, blanks between, or how many; empty: what fits
  BinType type = BinType::kAuto;
};
void bind(config::Binder& binder, BinStatements& statements);

/// How a file without a header holds points.
struct BinLayout {
  std::vector<std::string> columns;  ///< of each point, in order: "x", "y", "z", ...
  BinType type = BinType::kFloat32;

  /// x y z intensity as float32
  bool is_kitti() const;
};

/// The layout that is stated, or else the one that fits the first bytes of a few of `files`;
/// KITTI's where nothing else fits clearly better. Says in `facts` which and why.
///
/// Numbers that lie one point apart in a file resemble each other - they are of neighbours - more
/// than numbers that lie anything else apart: the count of columns is that of the best resemblance
/// which all sizes of files are a multiple of. The first three columns are coordinates, the fourth
/// the intensity; of the others the first that holds whole numbers is the ring, the first that does
/// not the time.
/// \throws files::InputError if what is stated cannot be.
BinLayout bin_layout(const std::vector<std::filesystem::path>& files, const Statements& statements,
                     std::vector<Fact>& facts);

/// \throws files::InputError if it cannot be read or does not hold whole points.
PointCloud read_bin_points(const std::filesystem::path& file, const BinLayout& layout);

}  // namespace traverse::dataset
