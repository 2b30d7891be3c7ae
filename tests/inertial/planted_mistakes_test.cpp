// The test of Jacobians is tested: mistakes that are easily made in the inertial factor (a sign, a
// transpose, a left Jacobian for a right one, a factor dropped as if it were the identity) must
// fail it, and the true formulas must pass.

#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/inertial/factor_kinds.hpp"
#include "traverse/optimization/jacobian_audit.hpp"

#include "residuals/inertial.hpp"
#include "residuals/state_blocks.hpp"

namespace traverse::inertial {
namespace {

using geometry::exp_so3;
using geometry::left_jacobian_inverse;
using geometry::right_jacobian;
using geometry::right_jacobian_inverse;
using optimization::FactorKind;

/// What a mistake changes: the Jacobians in i and j, given all that they are made from.
struct Parts {
  Eigen::Vector3d r_R;
  Eigen::Matrix3d Ri, Rj;
  Eigen::Matrix3d dR_dbg;  ///< d(dR)/d(bg)
  Eigen::Vector3d shift;   ///< dR_dbg (bg - bg0)
};
using Mistake = std::function<void(const Parts&, Jacobian<9>& Ji, Jacobian<9>& Jj)>;

auto bg(Jacobian<9>& Ji) { return Ji.block<3, 3>(0, NavState::kGyroBias); }

struct MistakenModel {
  static constexpr int kSize = 9;
  InertialResidual model;
  Mistake mistake;
  Residual<9> operator()(const NavState& i, const NavState& j, Jacobian<9>* Ji,
                         Jacobian<9>* Jj) const {
    const Residual<9> r = model(i, j, Ji, Jj);
    if (Ji == nullptr || Jj == nullptr) return r;
    const Eigen::Matrix3d& dR_dbg = model.imu->bias_jacobians().rotation_gyro;
    const Parts parts{r.head<3>(), i.rotation(), j.rotation(), dR_dbg,
                      dR_dbg * (i.gyro_bias - model.imu->gyro_bias())};
    mistake(parts, *Ji, *Jj);
    return r;
  }
};

/// A motion, and a state with |r_R| about 0.3 rad and a gyro bias 0.3 rad/s from the one that was
/// integrated about; at zero residual and bias all these mistakes vanish.
struct Situation {
  std::shared_ptr<Preintegration> imu;
  NavState i, j;
  Eigen::Vector3d gravity{0, 0, -9.81};
};

Situation situation(optimization::RandomStates& random) {
  Situation s;
  const Eigen::Vector3d gyro_bias = random.vector(0.02);
  const Eigen::Vector3d accelerometer_bias = random.vector(0.1);
  s.imu = std::make_shared<Preintegration>(ImuNoise{}, gyro_bias, accelerometer_bias);
  const Eigen::Vector3d rate = random.vector(1);
  for (int k = 0; k < 40; ++k) {
    s.imu->add(rate + random.vector(0.3), Eigen::Vector3d(0, 0, 9.8) + random.vector(3), 0.01);
  }
  s.i.q_map_body = Eigen::Quaterniond(random.quaternion(2).data());
  s.i.v_map = random.vector(10);
  s.i.gyro_bias = s.imu->gyro_bias() + 0.3 * random.unit_vector();
  s.i.accelerometer_bias = random.vector(0.5);
  NavState::Tangent off = NavState::Tangent::Random();
  off.head<3>() = 0.3 * random.unit_vector();
  s.j = s.imu->predict(s.i, s.gravity).plus(off);
  return s;
}

FactorKind kind_with(const Mistake& mistake) {
  FactorKind kind;
  kind.name = "inertial";
  for (const std::string name : {" i", " j"}) {
    kind.blocks.push_back({"rotation" + name, 4, true});
    for (const char* part : {"position", "velocity", "gyro bias", "accelerometer bias"}) {
      kind.blocks.push_back({part + name, 3, false});
    }
    kind.blocks.push_back({"wheel scale" + name, 1, false});
    kind.blocks.push_back({"wheel turn" + name, 2, false});
    kind.blocks.push_back({"GNSS latency" + name, 1, false});
    kind.blocks.push_back({"GNSS bias" + name, 3, false});
  }
  kind.perturbations = {optimization::Perturbation::kRight};
  kind.make = [mistake](optimization::RandomStates& random, optimization::Perturbation) {
    const Situation s = situation(random);
    optimization::FactorSample sample;
    const InertialResidual model{s.imu, s.gravity};
    sample.analytic = std::make_shared<LinkCost<MistakenModel>>(MistakenModel{model, mistake});
    sample.automatic = std::make_shared<LinkCost<InertialResidual>>(model);  // not what is tested
    for (const NavState& x : {s.i, s.j}) {
      sample.state.emplace_back(x.q_map_body.coeffs());
      sample.state.emplace_back(x.p_map);
      sample.state.emplace_back(x.v_map);
      sample.state.emplace_back(x.gyro_bias);
      sample.state.emplace_back(x.accelerometer_bias);
      sample.state.emplace_back(Eigen::VectorXd::Constant(1, x.wheel_scale));
      sample.state.emplace_back(x.wheel_turn);
      sample.state.emplace_back(Eigen::VectorXd::Constant(1, x.gnss_latency));
      sample.state.emplace_back(x.gnss_bias);
    }
    return sample;
  };
  return kind;
}

/// The relative difference to numeric derivatives of a block of state i.
double difference(const Mistake& mistake, const std::string& block) {
  optimization::AuditOptions options;
  options.states = 20;
  const auto kind = kind_with(mistake);
  const auto audit = optimization::audit_jacobians(std::span(&kind, 1), options);
  for (const auto& found : audit.factors.front().blocks) {
    if (found.block == block) return found.numeric.relative;
  }
  ADD_FAILURE() << "no block " << block;
  return 0;
}

constexpr double kTolerance = 1e-7;  // of the audit

TEST(PlantedMistakes, TheTrueFormulasPass) {
  const Mistake none = [](const Parts&, Jacobian<9>&, Jacobian<9>&) {};
  for (const std::string part :
       {"rotation", "position", "velocity", "gyro bias", "accelerometer bias"}) {
    EXPECT_LT(difference(none, part + " i"), kTolerance) << part;
    EXPECT_LT(difference(none, part + " j"), kTolerance) << part;
  }
}

TEST(PlantedMistakes, TheBooksFormOfTheBiasBlockIsTheShorterOne) {
  const Mistake book = [](const Parts& p, Jacobian<9>& Ji, Jacobian<9>&) {
    bg(Ji) = -right_jacobian_inverse(p.r_R) * exp_so3(p.r_R).transpose() * right_jacobian(p.shift) *
             p.dR_dbg;
  };
  EXPECT_LT(difference(book, "gyro bias i"), kTolerance);
}

struct Planted {
  const char* name;
  const char* block;
  Mistake mistake;
  double at_least;  ///< relative difference that it makes
};

TEST(PlantedMistakes, AreCaught) {
  const std::vector<Planted> all{
      {"minus forgotten in the bias block", "gyro bias i",
       [](const Parts&, Jacobian<9>& Ji, Jacobian<9>&) { bg(Ji) = (-bg(Ji)).eval(); }, 1},
      {"Exp(r) for its transpose", "gyro bias i",
       [](const Parts& p, Jacobian<9>& Ji, Jacobian<9>&) {
         bg(Ji) =
             -right_jacobian_inverse(p.r_R) * exp_so3(p.r_R) * right_jacobian(p.shift) * p.dR_dbg;
       },
       0.1},
      {"Exp(r)' dropped", "gyro bias i",
       [](const Parts& p, Jacobian<9>& Ji, Jacobian<9>&) {
         bg(Ji) = -right_jacobian_inverse(p.r_R) * right_jacobian(p.shift) * p.dR_dbg;
       },
       0.1},
      {"left for right Jacobian beside Exp(r)'", "gyro bias i",
       [](const Parts& p, Jacobian<9>& Ji, Jacobian<9>&) {
         bg(Ji) = -left_jacobian_inverse(p.r_R) * exp_so3(p.r_R).transpose() *
                  right_jacobian(p.shift) * p.dR_dbg;
       },
       0.1},
      {"Jr^-1 taken for the identity", "gyro bias i",
       [](const Parts& p, Jacobian<9>& Ji, Jacobian<9>&) {
         bg(Ji) = -exp_so3(p.r_R).transpose() * right_jacobian(p.shift) * p.dR_dbg;
       },
       0.05},
      {"Jr of the bias shift dropped", "gyro bias i",
       [](const Parts& p, Jacobian<9>& Ji, Jacobian<9>&) {
         bg(Ji) = -left_jacobian_inverse(p.r_R) * p.dR_dbg;
       },
       0.01},
      {"Ri' Rj for Rj' Ri", "rotation i",
       [](const Parts& p, Jacobian<9>& Ji, Jacobian<9>&) {
         Ji.block<3, 3>(0, NavState::kRotation) =
             -right_jacobian_inverse(p.r_R) * p.Ri.transpose() * p.Rj;
       },
       0.1},
      {"Jr^-1 dropped from the second rotation", "rotation j",
       [](const Parts&, Jacobian<9>&, Jacobian<9>& Jj) {
         Jj.block<3, 3>(0, NavState::kRotation).setIdentity();
       },
       0.05},
      {"position moved in the body for in the map", "position i",
       [](const Parts&, Jacobian<9>& Ji, Jacobian<9>&) {
         Ji.block<3, 3>(6, NavState::kPosition) = -Eigen::Matrix3d::Identity();
       },
       0.1},
      {"derivative of the velocity forgotten in the position", "velocity i",
       [](const Parts&, Jacobian<9>& Ji, Jacobian<9>&) {
         Ji.block<3, 3>(6, NavState::kVelocity).setZero();
       },
       0.1},
  };
  for (const Planted& planted : all) {
    EXPECT_GT(difference(planted.mistake, planted.block), planted.at_least) << planted.name;
  }
}

}  // namespace
}  // namespace traverse::inertial
