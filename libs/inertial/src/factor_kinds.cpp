#include "traverse/inertial/factor_kinds.hpp"

#include <array>
#include <memory>
#include <utility>

#include <ceres/cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>

#include "traverse/geometry/so3.hpp"

#include "automatic_models.hpp"
#include "link_models.hpp"
#include "state_blocks.hpp"
#include "state_factors.hpp"

namespace traverse::inertial {

using optimization::FactorKind;
using optimization::FactorSample;
using optimization::ParameterBlock;
using optimization::Perturbation;
using optimization::RandomStates;

namespace {

constexpr std::array<int, kStateBlocks> kBlockSizes{4, 3, 3, 3, 3, 1, 2, 1, 3};
constexpr std::array<const char*, kStateBlocks> kBlockNames{
    "rotation",    "position",   "velocity",     "gyro bias", "accelerometer bias",
    "wheel scale", "wheel turn", "GNSS latency", "GNSS bias"};

/// Parts of one or two states (numbers below or from kStateBlocks) that a factor depends on, and
/// the rows of the residual that are looked at.
struct View {
  std::vector<int> blocks;
  int first_row = 0;
  int rows = 0;
};

/// A cost function seen through a View: the blocks that are left out keep the values of `state`.
class ViewedCost final : public ceres::CostFunction {
 public:
  ViewedCost(std::shared_ptr<const ceres::CostFunction> whole, View view,
             std::vector<Eigen::VectorXd> state)
      : whole_(std::move(whole)), view_(std::move(view)), state_(std::move(state)) {
    set_num_residuals(view_.rows);
    for (const int block : view_.blocks) {
      mutable_parameter_block_sizes()->push_back(
          kBlockSizes[static_cast<std::size_t>(block) % kBlockSizes.size()]);
    }
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    std::vector<const double*> all;
    for (const auto& block : state_) all.push_back(block.data());
    std::vector<RowMajor> whole_jacobians(state_.size());
    std::vector<double*> places(state_.size(), nullptr);
    for (std::size_t k = 0; k < view_.blocks.size(); ++k) {
      const auto block = static_cast<std::size_t>(view_.blocks[k]);
      all[block] = parameters[k];
      if (jacobians == nullptr || jacobians[k] == nullptr) continue;
      whole_jacobians[block].resize(whole_->num_residuals(), state_[block].size());
      places[block] = whole_jacobians[block].data();
    }
    Eigen::VectorXd r(whole_->num_residuals());
    if (!whole_->Evaluate(all.data(), r.data(), jacobians == nullptr ? nullptr : places.data())) {
      return false;
    }
    Eigen::Map<Eigen::VectorXd>(residuals, view_.rows) = r.segment(view_.first_row, view_.rows);
    for (std::size_t k = 0; jacobians != nullptr && k < view_.blocks.size(); ++k) {
      if (jacobians[k] == nullptr) continue;
      const RowMajor& from = whole_jacobians[static_cast<std::size_t>(view_.blocks[k])];
      Eigen::Map<RowMajor>(jacobians[k], view_.rows, from.cols()) =
          from.middleRows(view_.first_row, view_.rows);
    }
    return true;
  }

 private:
  std::shared_ptr<const ceres::CostFunction> whole_;
  View view_;
  std::vector<Eigen::VectorXd> state_;
};

struct WholeSample {
  std::shared_ptr<const ceres::CostFunction> analytic;
  std::shared_ptr<const ceres::CostFunction> automatic;
};

/// Adds the blocks of a random state to `state`, turned so little that what two states differ by
/// stays below half a turn, where Log has no derivative.
void add_random_state(RandomStates& random, std::vector<Eigen::VectorXd>& state) {
  state.emplace_back(random.quaternion(1.1));
  state.emplace_back(random.vector(50));
  state.emplace_back(random.vector(15));
  state.emplace_back(random.vector(0.3));
  state.emplace_back(random.vector(0.5));
  state.emplace_back(Eigen::VectorXd::Constant(1, random.uniform(0.9, 1.1)));
  state.emplace_back(random.vector(0.5).head<2>());
  state.emplace_back(Eigen::VectorXd::Constant(1, random.uniform(0.05, 0.3)));
  state.emplace_back(random.vector(2));
}

NavState random_nav_state(RandomStates& random) {
  std::vector<Eigen::VectorXd> blocks;
  add_random_state(random, blocks);
  std::vector<const double*> pointers;
  for (const auto& block : blocks) pointers.push_back(block.data());
  return state_of(pointers.data());
}

template <typename Function>
std::shared_ptr<const ceres::CostFunction> automatic_cost(Function function, int states,
                                                          int residuals) {
  auto cost = std::make_shared<ceres::DynamicAutoDiffCostFunction<Function, 4>>(
      new Function(std::move(function)));
  for (int s = 0; s < states; ++s) {
    for (const int size : kBlockSizes) cost->AddParameterBlock(size);
  }
  cost->SetNumResiduals(residuals);
  return cost;
}

/// `make` gives the analytic and the automatic cost over all blocks of `states` states.
template <typename Make>
FactorKind kind(std::string name, std::string formula, int states, View view, const Make& make) {
  FactorKind result;
  result.name = std::move(name);
  result.formula = std::move(formula);
  result.perturbations = {Perturbation::kRight};
  for (const int block : view.blocks) {
    const auto part = static_cast<std::size_t>(block) % kBlockSizes.size();
    std::string label = kBlockNames[part];
    if (states == 2) label += block < kStateBlocks ? " i" : " j";
    result.blocks.push_back({label, kBlockSizes[part], part == 0});
  }
  result.make = [view, make, states](RandomStates& random, Perturbation) {
    std::vector<Eigen::VectorXd> state;
    for (int s = 0; s < states; ++s) add_random_state(random, state);
    const WholeSample whole = make(random);
    FactorSample sample;
    sample.analytic = std::make_shared<ViewedCost>(whole.analytic, view, state);
    sample.automatic = std::make_shared<ViewedCost>(whole.automatic, view, state);
    for (const int block : view.blocks) {
      sample.state.push_back(state[static_cast<std::size_t>(block)]);
    }
    return sample;
  };
  return result;
}

template <typename Call>
struct OneState {
  Call call;
  template <typename T>
  bool operator()(T const* const* blocks, T* residual) const {
    call(automatic::State<T>(blocks), residual);
    return true;
  }
};

template <typename Call>
struct TwoStates {
  Call call;
  template <typename T>
  bool operator()(T const* const* blocks, T* residual) const {
    call(automatic::State<T>(blocks), automatic::State<T>(blocks + kStateBlocks), residual);
    return true;
  }
};

template <typename Model, typename Call>
WholeSample of_state(const Model& model, Call call) {
  return {std::make_shared<StateCost<Model>>(model),
          automatic_cost(OneState<Call>{std::move(call)}, 1, Model::kSize)};
}

template <typename Model, typename Call>
WholeSample of_link(const Model& model, Call call) {
  return {std::make_shared<LinkCost<Model>>(model),
          automatic_cost(TwoStates<Call>{std::move(call)}, 2, Model::kSize)};
}

WholeSample inertial_sample(RandomStates& random) {
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
  kinds.push_back(kind("inertial rotation", "r = Log(dR(bg)' Ri' Rj)", 2,
                       {{kQ, kBg, kQ + kJ}, 0, 3}, inertial_sample));
  kinds.push_back(kind("inertial velocity", "r = Ri' (vj - vi - g T) - dv(bg, ba)", 2,
                       {{kQ, kV, kBg, kBa, kV + kJ}, 3, 3}, inertial_sample));
  kinds.push_back(kind("inertial position", "r = Ri' (pj - pi - vi T - g T^2 / 2) - dp(bg, ba)", 2,
                       {{kQ, kP, kV, kBg, kBa, kP + kJ}, 6, 3}, inertial_sample));
  kinds.push_back(
      kind("gyro bias walk", "r = bgj - bgi", 2, {{kBg, kBg + kJ}, 0, 3}, [](RandomStates&) {
        return of_link(GyroBiasWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          for (int k = 0; k < 3; ++k) {
            r[k] = j.gyro_bias[k] - i.gyro_bias[k];
          }
        });
      }));
  kinds.push_back(kind(
      "accelerometer bias walk", "r = baj - bai", 2, {{kBa, kBa + kJ}, 0, 3}, [](RandomStates&) {
        return of_link(AccelerometerBiasWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          for (int k = 0; k < 3; ++k) {
            r[k] = j.accelerometer_bias[k] - i.accelerometer_bias[k];
          }
        });
      }));
  kinds.push_back(
      kind("wheel scale walk", "r = sj - si", 2, {{kS, kS + kJ}, 0, 1}, [](RandomStates&) {
        return of_link(WheelScaleWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          r[0] = j.wheel_scale - i.wheel_scale;
        });
      }));
  kinds.push_back(
      kind("wheel turn walk", "r = mj - mi", 2, {{kTurn, kTurn + kJ}, 0, 2}, [](RandomStates&) {
        return of_link(WheelTurnWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          for (int k = 0; k < 2; ++k) r[k] = j.wheel_turn[k] - i.wheel_turn[k];
        });
      }));
  kinds.push_back(kind(
      "GNSS latency walk", "r = tj - ti", 2, {{kLatency, kLatency + kJ}, 0, 1}, [](RandomStates&) {
        return of_link(GnssLatencyWalkModel{}, [](const auto& i, const auto& j, auto* r) {
          r[0] = j.gnss_latency - i.gnss_latency;
        });
      }));
  kinds.push_back(kind(
      "GNSS bias walk", "r = cj - a ci", 2, {{kGnss, kGnss + kJ}, 0, 3}, [](RandomStates& random) {
        const double decay = random.uniform(0.5, 1);
        return of_link(GnssBiasWalkModel{decay}, [=](const auto& i, const auto& j, auto* r) {
          for (int k = 0; k < 3; ++k) r[k] = j.gnss_bias[k] - decay * i.gnss_bias[k];
        });
      }));
}

void add_state_kinds(std::vector<FactorKind>& kinds) {
  kinds.push_back(kind("prior", "r = (Log(R0' R), x - x0 for each other part)", 1,
                       {{kQ, kP, kV, kBg, kBa, kS, kTurn, kLatency, kGnss}, 0, NavState::kTangent},
                       [](RandomStates& random) {
                         const NavState expected = random_nav_state(random);
                         return of_state(PriorModel{expected}, [=](const auto& x, auto* r) {
                           automatic::prior(expected, x, r);
                         });
                       }));
  kinds.push_back(
      kind("GNSS position", "r = p + R l - t (v + R ((w - bg) x l)) + a t^2 / 2 + c - z", 1,
           {{kQ, kP, kV, kBg, kLatency, kGnss}, 0, 3}, [](RandomStates& random) {
             const AntennaFix fix{random.vector(50), random.vector(2), random.vector(1),
                                  random.vector(3)};
             return of_state(GnssPositionModel{fix},
                             [=](const auto& x, auto* r) { automatic::gnss_position(fix, x, r); });
           }));
  kinds.push_back(
      kind("heading", "r = wrap(atan2(R10, R00) - psi)", 1, {{kQ}, 0, 1}, [](RandomStates& random) {
        const double heading = random.uniform(-3, 3);
        return of_state(HeadingModel{heading},
                        [=](const auto& x, auto* r) { automatic::heading(heading, x, r); });
      }));
  kinds.push_back(kind("wheel velocity", "r = Exp(0, m) C (R' v + (w - bg) x l) - s (u, 0, 0)", 1,
                       {{kQ, kV, kBg, kS, kTurn}, 0, 3}, [](RandomStates& random) {
                         const double forward = random.uniform(1, 20);
                         WheelMount mount;
                         mount.R_wheels_body = geometry::exp_so3(random.vector(0.5));
                         mount.p_body = random.vector(2);
                         const Eigen::Vector3d rate = random.vector(1);
                         return of_state(WheelVelocityModel{forward, mount, rate},
                                         [=](const auto& x, auto* r) {
                                           automatic::wheel_velocity(forward, mount, rate, x, r);
                                         });
                       }));
  kinds.push_back(
      kind("zero velocity", "r = (v, w - bg)", 1, {{kV, kBg}, 0, 6}, [](RandomStates& random) {
        const Eigen::Vector3d rate = random.vector(1);
        return of_state(ZeroVelocityModel{rate},
                        [=](const auto& x, auto* r) { automatic::zero_velocity(rate, x, r); });
      }));
  kinds.push_back(
      kind("GNSS pose", "r = (Log(Rz' R), p - pz)", 1, {{kQ, kP}, 0, 6}, [](RandomStates& random) {
        const NavState x = random_nav_state(random);
        const geometry::Pose3 measured = x.T_map_body();
        return of_state(GnssPoseModel{measured}, [=](const auto& state, auto* r) {
          automatic::gnss_pose(measured, state, r);
        });
      }));
  kinds.push_back(kind("world velocity", "r = v - vz", 1, {{kV}, 0, 3}, [](RandomStates& random) {
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
