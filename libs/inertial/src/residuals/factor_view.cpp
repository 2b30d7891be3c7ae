#include "residuals/factor_view.hpp"

namespace traverse::inertial {

using optimization::FactorKind;
using optimization::FactorSample;
using optimization::Perturbation;
using optimization::RandomStates;

namespace {

constexpr std::array<const char*, kStateBlocks> kBlockNames{
    "rotation",    "position",   "velocity",     "gyro bias", "accelerometer bias",
    "wheel scale", "wheel turn", "GNSS latency", "GNSS bias"};

/// A cost function seen through a FactorView: the blocks that are left out keep the values of
/// `state`.
class ViewedCost final : public ceres::CostFunction {
 public:
  ViewedCost(std::shared_ptr<const ceres::CostFunction> whole, FactorView view,
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
  FactorView view_;
  std::vector<Eigen::VectorXd> state_;
};

/// Adds the blocks of a random state to `state`.
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

/// Adds the blocks of `x` to `state`.
void add_state(const NavState& x, std::vector<Eigen::VectorXd>& state) {
  state.emplace_back(x.q_map_body.coeffs());
  state.emplace_back(x.p_map);
  state.emplace_back(x.v_map);
  state.emplace_back(x.gyro_bias);
  state.emplace_back(x.accelerometer_bias);
  state.emplace_back(Eigen::VectorXd::Constant(1, x.wheel_scale));
  state.emplace_back(x.wheel_turn);
  state.emplace_back(Eigen::VectorXd::Constant(1, x.gnss_latency));
  state.emplace_back(x.gnss_bias);
}

/// Without what makes its samples.
FactorKind described(std::string name, std::string formula, std::size_t states,
                     const FactorView& view) {
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
  return result;
}

FactorSample viewed(const WholeFactor& whole, const FactorView& view,
                    const std::vector<Eigen::VectorXd>& state) {
  FactorSample sample;
  sample.analytic = std::make_shared<ViewedCost>(whole.analytic, view, state);
  sample.automatic = std::make_shared<ViewedCost>(whole.automatic, view, state);
  for (const int block : view.blocks) {
    sample.state.push_back(state[static_cast<std::size_t>(block)]);
  }
  return sample;
}

}  // namespace

NavState random_nav_state(RandomStates& random) {
  std::vector<Eigen::VectorXd> blocks;
  add_random_state(random, blocks);
  std::vector<const double*> pointers;
  pointers.reserve(blocks.size());
  for (const auto& block : blocks) pointers.push_back(block.data());
  return state_of(pointers.data());
}

FactorKind viewed_kind(std::string name, std::string formula, int states, const FactorView& view,
                       const std::function<WholeFactor(RandomStates&)>& make) {
  FactorKind result =
      described(std::move(name), std::move(formula), static_cast<std::size_t>(states), view);
  result.make = [view, make, states](RandomStates& random, Perturbation) {
    std::vector<Eigen::VectorXd> state;
    for (int s = 0; s < states; ++s) add_random_state(random, state);
    return viewed(make(random), view, state);
  };
  return result;
}

FactorKind viewed_kind_at(std::string name, std::string formula,
                          const std::vector<NavState>& states, const FactorView& view,
                          const WholeFactor& whole) {
  FactorKind result = described(std::move(name), std::move(formula), states.size(), view);
  std::vector<Eigen::VectorXd> blocks;
  for (const NavState& x : states) add_state(x, blocks);
  result.make = [view, whole, blocks](RandomStates&, Perturbation) {
    return viewed(whole, view, blocks);
  };
  return result;
}

}  // namespace traverse::inertial
