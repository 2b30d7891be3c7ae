#include "smoother/fixed_lag_smoother.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "inertial/chain.hpp"

namespace traverse::inertial {
namespace {

using optimization::Termination;
using testing::coasting;
using testing::fix;
using testing::smoother;
using testing::sure_but_of_position;

constexpr int kP = NavState::kPosition;
constexpr int kV = NavState::kVelocity;

WindowOptions window_of(int states, int iterations = 4) {
  WindowOptions options;
  options.states = states;
  options.iterations = iterations;
  return options;
}

TEST(FixedLagSmoother, AFixIsTheKalmanUpdate) {
  FixedLagSmoother chain = smoother(window_of(2));
  chain.start({}, sure_but_of_position(2));
  chain.add(fix({5, 0, 0}, 1));
  const auto solution = chain.solve();
  EXPECT_NEAR(chain.newest().p_map.x(), 4, 1e-6) << "5 m * 4 / (4 + 1)";
  EXPECT_NEAR(chain.newest().p_map.y(), 0, 1e-6);
  EXPECT_NEAR(solution.covariance(kP, kP), 0.8, 1e-6) << "4 * 1 / (4 + 1) m^2";
  EXPECT_NEAR(solution.cost, 2.5, 1e-6) << "half of 25 / (4 + 1)";
  EXPECT_TRUE(solution.covariance == chain.covariance());
  EXPECT_TRUE(solution.converged);
  EXPECT_EQ(solution.reason, Termination::kConverged);
  EXPECT_EQ(solution.iterations, 2) << "one that moves, one that finds nothing left to move";
}

TEST(FixedLagSmoother, WithoutMeasurementsItIsThePrior) {
  FixedLagSmoother chain = smoother(window_of(2));
  NavState state;
  state.p_map = {1, 2, 3};
  const NavState::Tangent sigma = sure_but_of_position(0.7);
  chain.start(state, sigma);
  const auto solution = chain.solve();
  EXPECT_EQ(solution.cost, 0);
  EXPECT_EQ(solution.reason, Termination::kConverged);
  EXPECT_EQ(chain.newest().minus(state).norm(), 0);
  for (int k = 0; k < NavState::kTangent; ++k) {
    EXPECT_NEAR(std::sqrt(solution.covariance(k, k)) / sigma[k], 1, 1e-9) << k;
  }
}

TEST(FixedLagSmoother, OneWithoutIterationsLeftSaysSo) {
  FixedLagSmoother chain = smoother(window_of(2, 1));
  chain.start({}, sure_but_of_position(2));
  chain.add(fix({5, 0, 0}, 1));
  const auto solution = chain.solve();
  EXPECT_FALSE(solution.converged);
  EXPECT_EQ(solution.reason, Termination::kIterationLimit);
  EXPECT_NEAR(chain.newest().p_map.x(), 4, 1e-6) << "which is no fault: it was linear";
  EXPECT_NEAR(solution.covariance(kP, kP), 0.8, 1e-6);
}

TEST(FixedLagSmoother, WhatNothingDeterminesIsAnError) {
  FixedLagSmoother chain = smoother(window_of(2));
  NavState::Tangent sigma = sure_but_of_position(1);
  sigma[kP] = std::numeric_limits<double>::infinity();
  chain.start({}, sigma);
  EXPECT_THROW(chain.solve(), std::runtime_error);
}

/// Where the prior pulls back by x / s^2 and Huber's loss pulls by k / s, the shift is k.
/// Asked before the solution, the innovation of a prediction is that of all its factors together,
/// one row after the other: its mean over their number is 1 where the covariances are right.
TEST(FixedLagSmoother, TellsHowThePredictionAgreesWithWhatConstrainsIt) {
  FixedLagSmoother chain = smoother(window_of(2));
  chain.start({}, sure_but_of_position(2));
  chain.append(coasting(0.1, chain.newest()));
  EXPECT_EQ(chain.innovation_of_newest().rows, 0);
  chain.add(fix({5, 0, 0}, 1));
  const Innovation one = chain.innovation_of_newest();
  EXPECT_EQ(one.rows, 3);
  EXPECT_NEAR(one.chi2, 5, 1e-3) << "25 / (4 + 1)";
  chain.add(fix({5, 0, 0}, 1));
  const Innovation both = chain.innovation_of_newest();
  EXPECT_EQ(both.rows, 6);
  EXPECT_NEAR(both.chi2, 25 / 4.5, 1e-3) << "they share the prediction's doubt: 25 / (4 + 1 / 2)";
}

TEST(FixedLagSmoother, HuberBoundsThePullOfAnOutlier) {
  for (const double outlier_m : {20.0, 100.0, 1000.0}) {
    FixedLagSmoother chain = smoother(window_of(2, 50));
    chain.start({}, sure_but_of_position(1));
    chain.add(fix({outlier_m, 0, 0}, 1, 3));
    EXPECT_EQ(chain.solve().reason, Termination::kConverged);
    EXPECT_NEAR(chain.newest().p_map.x(), 3, 1e-3) << outlier_m;
  }
}

TEST(FixedLagSmoother, AppendPredictsTheStateAndItsDoubt) {
  ImuNoise noise;
  noise.accelerometer_density = 0.1;
  FixedLagSmoother chain = smoother(window_of(5), noise);
  NavState state;
  state.v_map = {10, 0, 0};
  NavState::Tangent sigma = sure_but_of_position(1);
  sigma.segment<3>(kV).setConstant(0.5);
  chain.start(state, sigma);
  chain.append(coasting(1, chain.newest(), noise));
  EXPECT_EQ(chain.size(), 2U);
  EXPECT_NEAR(chain.newest().p_map.x(), 10, 1e-9);
  EXPECT_NEAR(chain.newest().v_map.x(), 10, 1e-9);
  EXPECT_NEAR(geometry::seconds_between(state.stamp, chain.newest().stamp), 1, 1e-9);
  // White noise of 0.1 m/s/sqrt(s) over 1 s, on top of what was not known before.
  const NavState::Matrix& P = chain.covariance();
  EXPECT_NEAR(P(kV, kV), 0.25 + 0.01, 1e-5);
  EXPECT_NEAR(P(kP, kV), 0.25 + 0.01 / 2, 1e-4);
  EXPECT_NEAR(P(kP, kP), 1 + 0.25 + 0.01 / 3, 1e-4);
}

TEST(FixedLagSmoother, WhatLeavesTheWindowIsKeptWhole) {
  const auto newest = [](int states) {
    FixedLagSmoother chain = smoother(window_of(states));
    NavState start;
    start.v_map = {3, 0, 0};
    NavState::Tangent sigma = sure_but_of_position(1);
    sigma.segment<3>(NavState::kRotation).setConstant(1e-4);  // nearly linear
    sigma.segment<3>(kV).setConstant(0.5);
    sigma.segment<3>(NavState::kAccelerometerBias).setConstant(0.01);
    chain.start(start, sigma);
    std::mt19937 generator(1);
    std::normal_distribution<double> noise(0, 0.1);
    for (int k = 1; k <= 30; ++k) {
      chain.append(coasting(0.1, chain.newest()));
      const double x = noise(generator);
      const double y = noise(generator);
      chain.add(fix({0.3 * k + x, y, 0}, 0.1));
      chain.solve();
      EXPECT_LE(chain.size(), static_cast<std::size_t>(states));
    }
    return std::pair{chain.newest(), chain.covariance()};
  };
  const auto [whole, P_whole] = newest(1000);
  for (const int states : {2, 5}) {
    const auto [lagged, P] = newest(states);
    const NavState::Tangent d = lagged.minus(whole);
    for (int k = 0; k < NavState::kTangent; ++k) {
      const double sigma = std::sqrt(P_whole(k, k));
      EXPECT_LT(std::abs(d[k]), 1e-3 * sigma) << states << " states, unknown " << k;
      EXPECT_NEAR(std::sqrt(P(k, k)) / sigma, 1, 1e-3) << states << " states, unknown " << k;
    }
  }
}

TEST(FixedLagSmoother, CovariancesOfAllStatesKnowWhatCameLater) {
  FixedLagSmoother chain = smoother(window_of(10));
  NavState::Tangent sigma = sure_but_of_position(1);
  sigma.segment<3>(kV).setConstant(0.5);
  chain.start({}, sigma);
  std::vector<double> at_its_moment;
  for (int k = 0; k < 6; ++k) {
    if (k > 0) chain.append(coasting(0.5, chain.newest()));
    chain.add(fix(Eigen::Vector3d::Zero(), 0.3));
    at_its_moment.push_back(chain.solve().covariance(kP, kP));
  }
  const auto covariances = chain.covariances();
  ASSERT_EQ(covariances.size(), chain.size());
  EXPECT_LT((covariances.back() - chain.covariance()).norm(), 1e-9 * chain.covariance().norm());
  for (std::size_t k = 0; k + 1 < covariances.size(); ++k) {
    EXPECT_LT(covariances[k](kP, kP), 0.9 * at_its_moment[k]) << k;
  }
}

TEST(FixedLagSmoother, FindsABiasAndIntegratesAgainAboutIt) {
  FixedLagSmoother chain = smoother(window_of(10));
  const Eigen::Vector3d bias(0.5, -0.3, 0.2);  // far beyond reintegrate_accelerometer
  NavState::Tangent sigma = sure_but_of_position(0.1);
  sigma.segment<3>(kV).setConstant(0.1);
  sigma.segment<3>(NavState::kAccelerometerBias).setConstant(1);
  chain.start({}, sigma);
  for (int k = 0; k < 50; ++k) {
    chain.append(coasting(0.1, chain.newest(), {}, bias));
    chain.add(fix(Eigen::Vector3d::Zero(), 0.01));
    chain.solve();
  }
  EXPECT_LT((chain.newest().accelerometer_bias - bias).norm(), 0.01);
  EXPECT_LT(chain.newest().v_map.norm(), 0.01);
}

TEST(FixedLagSmoother, ACopyGoesOnAlikeAndIndependently) {
  const auto go_on = [](FixedLagSmoother& chain) {
    for (int k = 0; k < 20; ++k) {
      chain.append(coasting(0.1, chain.newest(), {}, {0.5, 0, 0}));
      chain.add(fix(Eigen::Vector3d::Zero(), 0.01));
      chain.solve();  // which integrates again about the bias
    }
  };
  FixedLagSmoother chain = smoother(window_of(10));
  NavState::Tangent sigma = sure_but_of_position(0.1);
  sigma.segment<3>(NavState::kAccelerometerBias).setConstant(1);
  chain.start({}, sigma);
  for (int k = 0; k < 3; ++k) {
    chain.append(coasting(0.1, chain.newest(), {}, {0.5, 0, 0}));
    chain.add(fix(Eigen::Vector3d::Zero(), 0.01));
  }
  FixedLagSmoother copy = chain;
  go_on(chain);
  go_on(copy);
  EXPECT_EQ(chain.newest().minus(copy.newest()).norm(), 0);
  EXPECT_TRUE(chain.covariance() == copy.covariance());
}

TEST(FixedLagSmoother, TheWindowEndsByStatesOrBySeconds) {
  FixedLagSmoother by_states = smoother(window_of(4));
  WindowOptions options = window_of(1000);
  options.seconds = 0.35;
  FixedLagSmoother by_seconds = smoother(options);
  for (FixedLagSmoother* chain : {&by_states, &by_seconds}) {
    chain->start({}, sure_but_of_position(1));
    for (int k = 0; k < 10; ++k) {
      chain->append(coasting(0.1, chain->newest()));
      chain->solve();
    }
    EXPECT_TRUE(chain->is_full());
  }
  EXPECT_EQ(by_states.size(), 4U);
  // The oldest is let go before the state that would make it too old is there.
  EXPECT_EQ(by_seconds.size(), 5U);
  EXPECT_NEAR(geometry::seconds_between(by_seconds.state(0).stamp, by_seconds.newest().stamp), 0.4,
              1e-9);
}

TEST(FixedLagSmoother, FactorsOfTheLastTwoStatesCountOnceEach) {
  FixedLagSmoother chain = smoother(window_of(3));
  chain.start({}, sure_but_of_position(1));
  chain.append(coasting(0.1, chain.newest()));
  chain.add_to_last(fix({0.1, 0, 0}, 1));
  chain.add(fix({0, 0.1, 0}, 1));
  const double cost = chain.solve().cost;
  EXPECT_NEAR(chain.state(0).p_map.x(), chain.newest().p_map.x(), 1e-4) << "hardly any speed";
  // Two fixes with the prior, each of 1 m: a third of what each says; sum of squares as by hand.
  EXPECT_NEAR(chain.newest().p_map.x(), 0.1 / 3, 1e-4);
  EXPECT_NEAR(chain.newest().p_map.y(), 0.1 / 3, 1e-4);
  EXPECT_NEAR(cost, (2 * 0.01 - 2 * 0.01 / 3) / 2, 1e-5);
  EXPECT_THROW(chain.append(std::make_shared<Preintegration>(ImuNoise{}, Eigen::Vector3d::Zero(),
                                                             Eigen::Vector3d::Zero())),
               std::invalid_argument)
      << "no sample is no link";
}

}  // namespace
}  // namespace traverse::inertial
