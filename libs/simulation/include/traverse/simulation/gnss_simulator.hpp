#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/sensors/gnss_fix.hpp"
#include "traverse/simulation/counter_noise.hpp"
#include "traverse/simulation/mounting.hpp"
#include "traverse/simulation/surroundings.hpp"
#include "traverse/simulation/vehicle_motion.hpp"

namespace traverse::simulation {

enum class GnssMode {
  kRtk,        ///< centimetres under open sky, decimetres where half of it is hidden
  kStandard,   ///< metres that wander slowly
  kMultipath,  ///< the same, and worse the more of the sky is hidden
};

struct GnssSettings {
  bool mounted = true;
  Mounting mounting{0.3, 0, 1.6, 0, 0, 0};  ///< of the main antenna: the lever arm
  GnssMode mode = GnssMode::kRtk;
  double rate_hz = 5;
  bool dual_antenna = true;        ///< gives headings
  double heading_noise_deg = 0.2;  ///< standard deviation
  double heading_from_mps = 0;     ///< headings are given from this speed on
  /// RTK now and then loses its ambiguities for a few seconds: it is then a decimetre or two off.
  double step_m = 0;              ///< standard deviation of each axis; twice that in height
  double steps_every_s = 20;      ///< on average
  double step_s = 2;              ///< how long, on average
  std::vector<double> outages_s;  ///< from and to by turns, seconds of the drive
  double latitude_deg = 48.1;     ///< of the map's origin
  double longitude_deg = 11.6;
  double altitude_m = 520;
};
void bind(config::Binder& binder, GnssSettings& settings);

/// What a satellite receiver reports. The map is the plane that touches the ellipsoid at the
/// origin, x east, y north. No fix where less than a fifth of the sky is open, and during outages.
class GnssSimulator {
 public:
  /// The references must outlive this.
  GnssSimulator(const GnssSettings& settings, const Surroundings& surroundings,
                const VehicleMotion& motion, std::uint64_t seed);
  ~GnssSimulator();

  /// Sample `i`, i / rate seconds into the drive, if there is a fix; to be asked for in order,
  /// because errors wander.
  std::optional<sensors::GnssFix> sample(std::size_t i);

  /// Latitude, longitude [degrees] and altitude [m] of a point of the map.
  Eigen::Vector3d geodetic(const Eigen::Vector3d& p_map) const;

 private:
  bool is_out(double seconds) const;
  Eigen::Vector3d step(std::size_t i);
  Eigen::Vector3d error(std::size_t i, double open_sky, Eigen::Vector3d& deviation);

  struct Plane;
  GnssSettings settings_;
  const Surroundings& surroundings_;
  const VehicleMotion& motion_;
  geometry::Pose3 T_body_antenna_;
  CounterNoise noise_;
  std::unique_ptr<Plane> plane_;
  Eigen::Vector3d slow_ = Eigen::Vector3d::Zero();  ///< wandering errors in units of deviations
  Eigen::Vector3d fast_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero();  ///< m; zero while ambiguities are right
};

}  // namespace traverse::simulation
