#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <Eigen/Core>

namespace traverse::exports {

/// What a LAS file says of all its points.
struct LasDescription {
  std::string wkt;  ///< coordinate system; see coordinate_system.hpp
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< near the data: 2147 km are reached
  bool is_gps_time = true;   ///< times are adjusted standard GPS time; else of a clock of its own
  std::string generated_by;  ///< "Traverse 0.2.0"
  int year = 1;              ///< of creation
  int day_of_year = 1;
};

struct LasPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the coordinate system [m]
  double time_s = 0;
  std::uint16_t intensity = 0;  ///< 65535 at full reflectance
  std::uint16_t source = 0;     ///< number of the run that saw it
  std::uint8_t user_data = 0;   ///< the ring
};

/// Writes points of format 6 as LAS 1.4 (ASPRS, "LAS Specification 1.4 - R15", 2019) in the order
/// in which they come, each coordinate to the nearest millimetre; memory does not grow with their
/// number. The file appears when it is whole.
class LasWriter {
 public:
  /// \throws files::OutputError
  LasWriter(const std::filesystem::path& file, const LasDescription& description);
  LasWriter(LasWriter&&) noexcept;
  LasWriter& operator=(LasWriter&&) noexcept;
  ~LasWriter();

  /// \throws std::out_of_range for a point that is more than 2147 km from the offset or no number
  void add(const LasPoint& point);
  std::uint64_t size() const;

  /// Completes the header and gives the file its name. \throws files::OutputError
  void commit();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace traverse::exports
