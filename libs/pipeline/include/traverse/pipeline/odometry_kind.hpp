#pragma once

#include <functional>
#include <memory>
#include <string>

#include "traverse/config/binder.hpp"
#include "traverse/lidar/odometry.hpp"
#include "traverse/sensors/lidar_profile.hpp"

namespace traverse::pipeline {

/// The settings of a lidar odometry, and how it is made from them.
class OdometrySettings {
 public:
  virtual ~OdometrySettings() = default;

  /// Presents each setting: so a preset is read, checked and listed.
  virtual void present(config::Binder& binder) = 0;

  /// \param profile of the lidar  \param motion_compensated its scans need no deskew
  /// \param threads to use; the result must not depend on it
  virtual std::unique_ptr<lidar::Odometry> make(const sensors::LidarProfile& profile,
                                                bool motion_compensated, int threads) const = 0;
};

/// A kind of lidar odometry: makes its settings, with the values that they have by default.
using OdometryKind = std::function<std::unique_ptr<OdometrySettings>()>;

/// The kind of an odometry that is constructed from (options, profile, motion_compensated), whose
/// options have a bind() (see config::Binder) and, if it uses them, a member `threads`.
template <typename Odometry, typename Options>
OdometryKind odometry_kind() {
  class Settings final : public OdometrySettings {
   public:
    void present(config::Binder& binder) override { bind(binder, options_); }

    std::unique_ptr<lidar::Odometry> make(const sensors::LidarProfile& profile,
                                          bool motion_compensated, int threads) const override {
      Options options = options_;
      if constexpr (requires { options.threads = threads; }) options.threads = threads;
      return std::make_unique<Odometry>(options, profile, motion_compensated);
    }

   private:
    Options options_;
  };
  return [] { return std::make_unique<Settings>(); };
}

/// Lets presets name a lidar odometry of your own: `estimator: NAME`. It then has what the others
/// have: loops over it and localisation with it (the settings slam.*), its place in `run`, in the
/// report and in a replay. Call it before pipelines are made; other threads must not make any
/// meanwhile. \throws std::invalid_argument if there is an estimator of that name.
void register_odometry(const std::string& name, const OdometryKind& kind);

}  // namespace traverse::pipeline
