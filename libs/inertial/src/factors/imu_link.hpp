#pragma once

#include <memory>
#include <optional>

#include "traverse/inertial/interpolated_reading.hpp"
#include "traverse/inertial/nav_state.hpp"
#include "traverse/sensors/imu_sample.hpp"

#include "factors/imu_shaking.hpp"
#include "factors/preintegration.hpp"

namespace traverse::inertial {

/// What the IMU has measured since the newest state, up to its last reading.
class ImuLink {
 public:
  explicit ImuLink(const ImuNoise& noise) : noise_(noise), shaking_(noise) {}
  /// A copy has a pre-integration of its own, which samples join.
  ImuLink(const ImuLink& other);
  ImuLink& operator=(const ImuLink&) = delete;

  /// Begins at `state`, keeping the last reading.
  void begin(const NavState& state);

  /// A reading as it came, before it or what lies between two of them is integrated.
  void observe(const sensors::ImuSample& sample) { shaking_.add(sample); }

  /// What a step of the IMU did.
  struct Step {
    double speed_change_mps = 0;  ///< forward
    double way_m = 0;
    double seconds = 0;
    Eigen::Vector3d velocity_change_map = Eigen::Vector3d::Zero();  ///< m/s
    bool is_gap = false;  ///< longer than readings of an IMU are apart
  };
  /// Integrates from the last reading to `sample`. \pre begin() was called, last() is earlier
  Step add(const sensors::ImuSample& sample, const NavState& newest,
           const Eigen::Vector3d& gravity_map);

  const std::optional<sensors::ImuSample>& last() const { return last_; }
  void set_last(const std::optional<sensors::ImuSample>& sample) { last_ = sample; }

  /// The largest densities that were used in place of those that are told.
  std::optional<ImuShaking::Densities> shaking() const { return shaking_.most(); }

  /// Predicted, at the last reading.
  const Eigen::Quaterniond& attitude() const { return q_map_body_; }

  /// Ready to be a link of the chain.
  std::shared_ptr<Preintegration> take();

  /// The acceleration in the map at the last reading, with the attitude and bias of `state`.
  Eigen::Vector3d acceleration(const NavState& state, const Eigen::Vector3d& gravity_map) const;

 private:
  ImuNoise noise_;
  ImuShaking shaking_;
  std::shared_ptr<Preintegration> imu_;
  std::optional<sensors::ImuSample> last_;
  double forward_mps_ = 0;  ///< predicted, at the last reading
  Eigen::Vector3d v_map_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_map_body_ = Eigen::Quaterniond::Identity();
};

}  // namespace traverse::inertial
