#include "traverse/inertial/factor_kinds.hpp"

#include <memory>

#include "traverse/geometry/so3.hpp"

#include "factors/factor_view.hpp"

namespace traverse::inertial {

using optimization::FactorKind;
using optimization::RandomStates;

namespace {

WholeFactor inertial_sample(RandomStates& random) {
  auto imu = std::make_shared<Preintegration>(ImuNoise{}, random.vector(0.02), random.vector(0.1));
  const Eigen::Vector3d rate = random.vector(1);
  const Eigen::Vector3d force = Eigen::Vector3d(0, 0, 9.8) + random.vector(3);
  for (int k = 0; k < 40; ++k) imu->add(rate + random.vector(0.3), force + random.vector(1), 0.01);
  const Eigen::Vector3d gravity(0, 0, -9.81);
  return of_link(InertialModel{imu, gravity}, [=](const auto& i, const auto& j, auto* r) {
    automatic::inertial(*imu, gravity, i, j, r);
  });
}

enum Block : int { kQ, kP, kV, kBg, kBa, kS, kTurn, kLatency, kGnss };
constexpr int kJ = kStateBlocks;  // added to a Block: the same part of the second state

void add_link_kinds(std::vector<FactorKind>& kinds) {
  kinds.push_back(viewed_kind("inertial rotation", "r = Log(dR(bg)' Ri' Rj)", 2,
                              {{kQ, kBg, kQ + kJ}, 0, 3}, inertial_sample));
  kinds.push_back(viewed_kind("inertial velocity", "r = Ri' (vj - vi - g T) - dv(bg, ba)", 2,
                              {{kQ, kV, kBg, kBa, kV + kJ}, 3, 3}, inertial_sample));
  kinds.push_back(viewed_kind("inertial position",
                              "r = Ri' (pj - pi - vi T - g T^2 / 2) - dp(bg, ba)", 2,
                              {{kQ, kP, kV, kBg, kBa, kP + kJ}, 6, 3}, inertial_sample));
  kinds.push_back(
      viewed_kind("gyro bias walk", "r = bgj - bgi", 2, {{kBg, kBg + kJ}, 0, 3}, [](RandomStates&) {
        return of_link(GyroBiasWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          for (int k = 0; k < 3; ++k) {
            r[k] = j.gyro_bias[k] - i.gyro_bias[k];
          }
        });
      }));
  kinds.push_back(viewed_kind(
      "accelerometer bias walk", "r = baj - bai", 2, {{kBa, kBa + kJ}, 0, 3}, [](RandomStates&) {
        return of_link(AccelerometerBiasWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          for (int k = 0; k < 3; ++k) {
            r[k] = j.accelerometer_bias[k] - i.accelerometer_bias[k];
          }
        });
      }));
  kinds.push_back(
      viewed_kind("wheel scale walk", "r = sj - si", 2, {{kS, kS + kJ}, 0, 1}, [](RandomStates&) {
        return of_link(WheelScaleWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          r[0] = j.wheel_scale - i.wheel_scale;
        });
      }));
  kinds.push_back(viewed_kind(
      "wheel turn walk", "r = mj - mi", 2, {{kTurn, kTurn + kJ}, 0, 2}, [](RandomStates&) {
        return of_link(WheelTurnWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          for (int k = 0; k < 2; ++k) r[k] = j.wheel_turn[k] - i.wheel_turn[k];
        });
      }));
  kinds.push_back(viewed_kind(
      "GNSS latency walk", "r = tj - ti", 2, {{kLatency, kLatency + kJ}, 0, 1}, [](RandomStates&) {
        return of_link(GnssLatencyWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          r[0] = j.gnss_latency - i.gnss_latency;
        });
      }));
  kinds.push_back(viewed_kind(
      "GNSS bias walk", "r = cj - a ci", 2, {{kGnss, kGnss + kJ}, 0, 3}, [](RandomStates& random) {
        const double decay = random.uniform(0.5, 1);
        return of_link(GnssBiasWalkModel{decay}, [=](const auto& i, const auto& j, auto* r) {
          for (int k = 0; k < 3; ++k) r[k] = j.gnss_bias[k] - decay * i.gnss_bias[k];
        });
      }));
}

void add_state_kinds(std::vector<FactorKind>& kinds) {
  kinds.push_back(viewed_kind(
      "prior", "r = (Log(R0' R), x - x0 for each other part)", 1,
      {{kQ, kP, kV, kBg, kBa, kS, kTurn, kLatency, kGnss}, 0, NavState::kTangent},
      [](RandomStates& random) {
        const NavState expected = random_nav_state(random);
        return of_state(PriorModel{expected},
                        [=](const auto& x, auto* r) { automatic::prior(expected, x, r); });
      }));
  kinds.push_back(viewed_kind(
      "GNSS position", "r = p + R l - t (v + R ((w - bg) x l)) + a t^2 / 2 + c - z", 1,
      {{kQ, kP, kV, kBg, kLatency, kGnss}, 0, 3}, [](RandomStates& random) {
        const AntennaFix fix{random.vector(50), random.vector(2), random.vector(1),
                             random.vector(3)};
        return of_state(GnssPositionModel{fix},
                        [=](const auto& x, auto* r) { automatic::gnss_position(fix, x, r); });
      }));
  kinds.push_back(viewed_kind(
      "heading", "r = wrap(atan2(R10, R00) - psi)", 1, {{kQ}, 0, 1}, [](RandomStates& random) {
        const double heading = random.uniform(-3, 3);
        return of_state(HeadingModel{heading},
                        [=](const auto& x, auto* r) { automatic::heading(heading, x, r); });
      }));
  kinds.push_back(viewed_kind(
      "wheel velocity", "r = Exp(0, m) C (R' v + (w - bg) x l) - s (u, 0, 0)", 1,
      {{kQ, kV, kBg, kS, kTurn}, 0, 3}, [](RandomStates& random) {
        const double forward = random.uniform(1, 20);
        WheelMount mount;
        mount.R_wheels_body = geometry::exp_so3(random.vector(0.5));
        mount.p_body = random.vector(2);
        const Eigen::Vector3d rate = random.vector(1);
        return of_state(WheelVelocityModel{forward, mount, rate}, [=](const auto& x, auto* r) {
          automatic::wheel_velocity(forward, mount, rate, x, r);
        });
      }));
  kinds.push_back(viewed_kind(
      "zero velocity", "r = (v, w - bg)", 1, {{kV, kBg}, 0, 6}, [](RandomStates& random) {
        const Eigen::Vector3d rate = random.vector(1);
        return of_state(ZeroVelocityModel{rate},
                        [=](const auto& x, auto* r) { automatic::zero_velocity(rate, x, r); });
      }));
  kinds.push_back(viewed_kind(
      "GNSS pose", "r = (Log(Rz' R), p - pz)", 1, {{kQ, kP}, 0, 6}, [](RandomStates& random) {
        const NavState x = random_nav_state(random);
        const geometry::Pose3 measured = x.T_map_body();
        return of_state(GnssPoseModel{measured}, [=](const auto& state, auto* r) {
          automatic::gnss_pose(measured, state, r);
        });
      }));
  kinds.push_back(
      viewed_kind("world velocity", "r = v - vz", 1, {{kV}, 0, 3}, [](RandomStates& random) {
        const Eigen::Vector3d measured = random.vector(15);
        return of_state(WorldVelocityModel{measured},
                        [=](const auto& x, auto* r) { automatic::world_velocity(measured, x, r); });
      }));
}

}  // namespace

std::vector<FactorKind> factor_kinds() {
  std::vector<FactorKind> kinds;
  add_link_kinds(kinds);
  add_state_kinds(kinds);
  return kinds;
}

}  // namespace traverse::inertial
