#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <ceres/cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>

#include "traverse/optimization/factor_kind.hpp"

#include "residuals/automatic_state.hpp"
#include "residuals/state_blocks.hpp"

/// How the factors of one or two states, whose cost functions take every block of them, are shown
/// to the check of Jacobians with the blocks alone that they depend on.
namespace traverse::inertial {

inline constexpr std::array<int, kStateBlocks> kBlockSizes{4, 3, 3, 3, 3, 1, 2, 1, 3};

/// The parts of a state, in the order of its blocks.
namespace block {
enum Block : int {
  kRotation,
  kPosition,
  kVelocity,
  kGyroBias,
  kAccelerometerBias,
  kWheelScale,
  kWheelTurn,
  kGnssLatency,
  kGnssBias
};
}  // namespace block

/// The same part of the second state.
constexpr int of_j(int block) { return block + kStateBlocks; }

/// Parts of one or two states that a factor depends on, and the rows of the residual that are
/// looked at.
struct FactorView {
  std::vector<int> blocks;
  int first_row = 0;
  int rows = 0;
};

/// One factor over all blocks of its states: by its own derivatives and by Ceres' dual numbers.
struct WholeFactor {
  std::shared_ptr<const ceres::CostFunction> analytic;
  std::shared_ptr<const ceres::CostFunction> automatic;
};

/// \param make gives a random factor over all blocks of `states` states
optimization::FactorKind viewed_kind(
    std::string name, std::string formula, int states, const FactorView& view,
    const std::function<WholeFactor(optimization::RandomStates&)>& make);

/// The same of one factor at states that are known: make() gives these whatever is drawn.
optimization::FactorKind viewed_kind_at(std::string name, std::string formula,
                                        const std::vector<NavState>& states, const FactorView& view,
                                        const WholeFactor& whole);

/// Turned so little that what two states differ by stays below half a turn, where Log has no
/// derivative.
NavState random_nav_state(optimization::RandomStates& random);

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
WholeFactor of_state(const Model& model, Call call) {
  return {std::make_shared<StateCost<Model>>(model),
          automatic_cost(OneState<Call>{std::move(call)}, 1, Model::kSize)};
}

template <typename Model, typename Call>
WholeFactor of_link(const Model& model, Call call) {
  return {std::make_shared<LinkCost<Model>>(model),
          automatic_cost(TwoStates<Call>{std::move(call)}, 2, Model::kSize)};
}

}  // namespace traverse::inertial
