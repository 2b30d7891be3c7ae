#include "traverse/exports/gps_time.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace traverse::exports {

namespace {

constexpr std::int64_t kGpsEpoch_s = 315'964'800;  // 1980-01-06, Unix time
/// Unix time of the first moment after each leap second since.
constexpr std::array<std::int64_t, 18> kLeaps_s{
    362'793'600,    // 1981-07-01
    394'329'600,    // 1982-07-01
    425'865'600,    // 1983-07-01
    489'024'000,    // 1985-07-01
    567'993'600,    // 1988-01-01
    631'152'000,    // 1990-01-01
    662'688'000,    // 1991-01-01
    709'948'800,    // 1992-07-01
    741'484'800,    // 1993-07-01
    773'020'800,    // 1994-07-01
    820'454'400,    // 1996-01-01
    867'715'200,    // 1997-07-01
    915'148'800,    // 1999-01-01
    1'136'073'600,  // 2006-01-01
    1'230'768'000,  // 2009-01-01
    1'341'100'800,  // 2012-07-01
    1'435'708'800,  // 2015-07-01
    1'483'228'800,  // 2017-01-01
};

}  // namespace

std::optional<double> adjusted_gps_time(geometry::Stamp unix_time) {
  constexpr std::int64_t kNano = 1'000'000'000;
  if (unix_time.nanoseconds < kGpsEpoch_s * kNano) return std::nullopt;
  const std::int64_t seconds = unix_time.nanoseconds / kNano;
  const auto leaps = std::upper_bound(kLeaps_s.begin(), kLeaps_s.end(), seconds) - kLeaps_s.begin();
  const std::int64_t whole = seconds - kGpsEpoch_s + leaps - 1'000'000'000;
  return static_cast<double>(whole) + 1e-9 * static_cast<double>(unix_time.nanoseconds % kNano);
}

}  // namespace traverse::exports
