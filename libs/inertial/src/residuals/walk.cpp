#include "residuals/walk.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

namespace {

/// The numbers of block `kBlock` of an automatic::State.
template <int kBlock, typename T>
const T* values_of(const automatic::State<T>& x) {
  if constexpr (kBlock == block::kGyroBias) return x.gyro_bias.data();
  if constexpr (kBlock == block::kAccelerometerBias) return x.accelerometer_bias.data();
  if constexpr (kBlock == block::kWheelScale) return &x.wheel_scale;
  if constexpr (kBlock == block::kWheelTurn) return x.wheel_turn.data();
  if constexpr (kBlock == block::kGnssLatency) return &x.gnss_latency;
  if constexpr (kBlock == block::kGnssBias) return x.gnss_bias.data();
}

/// \param decays  whether a share below one is left; else all of it is
template <typename Walk, int kBlock>
optimization::FactorKind walk_kind(const char* name, const char* formula, bool decays = false) {
  return viewed_kind(name, formula, 2, {{kBlock, of_j(kBlock)}, 0, Walk::kSize},
                     [decays](optimization::RandomStates& random) {
                       const double decay = decays ? random.uniform(0.5, 1) : 1;
                       return of_link(Walk{decay}, [=](const auto& i, const auto& j, auto* r) {
                         for (int k = 0; k < Walk::kSize; ++k) {
                           r[k] = values_of<kBlock>(j)[k] - decay * values_of<kBlock>(i)[k];
                         }
                       });
                     });
}

}  // namespace

std::vector<optimization::FactorKind> walk_kinds() {
  return {walk_kind<GyroBiasWalk, block::kGyroBias>("gyro bias walk", "r = bgj - bgi"),
          walk_kind<AccelerometerBiasWalk, block::kAccelerometerBias>("accelerometer bias walk",
                                                                      "r = baj - bai"),
          walk_kind<WheelScaleWalk, block::kWheelScale>("wheel scale walk", "r = sj - si"),
          walk_kind<WheelTurnWalk, block::kWheelTurn>("wheel turn walk", "r = mj - mi"),
          walk_kind<GnssLatencyWalk, block::kGnssLatency>("GNSS latency walk", "r = tj - ti"),
          walk_kind<GnssBiasWalk, block::kGnssBias>("GNSS bias walk", "r = cj - a ci", true)};
}

}  // namespace traverse::inertial
