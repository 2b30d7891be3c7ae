#include "velodyne_block.hpp"

#include <array>

#include "byte_fields.hpp"

// Compiled for AVX2 as well, and the processor chooses. Not under sanitizers, which are not set up
// yet when it does.
#if defined(__x86_64__) && !defined(TRAVERSE_SANITIZED)
#define TRAVERSE_PACKETS_AVX2 1
#include <immintrin.h>
#endif

namespace traverse::packets {

namespace {

#ifdef TRAVERSE_PACKETS_AVX2

constexpr std::size_t kLanes = 8;

/// Of each set of lanes, which of them come first: those that are in it, in their order.
struct LaneOrders {
  std::array<std::array<std::uint8_t, kLanes>, 256> of{};
};

constexpr LaneOrders make_lane_orders() {
  LaneOrders orders;
  for (std::size_t set = 0; set < orders.of.size(); ++set) {
    std::size_t n = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if ((set >> lane & 1) != 0) orders.of[set][n++] = static_cast<std::uint8_t>(lane);
    }
  }
  return orders;
}

constexpr LaneOrders kLaneOrders = make_lane_orders();

#define TRAVERSE_LANES [[gnu::target("avx2,popcnt"), gnu::always_inline]] inline

/// The 24 bytes of eight returns, twelve in each half.
TRAVERSE_LANES __m256i load_returns(const std::uint8_t* at) {
  const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
  const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at + 12));
  return _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
}

TRAVERSE_LANES __m256i distances_of(__m256i returns) {
  const __m256i bytes =
      _mm256_setr_epi8(0, 1, -1, -1, 3, 4, -1, -1, 6, 7, -1, -1, 9, 10, -1, -1,  //
                       0, 1, -1, -1, 3, 4, -1, -1, 6, 7, -1, -1, 9, 10, -1, -1);
  return _mm256_shuffle_epi8(returns, bytes);
}

TRAVERSE_LANES __m256i intensities_of(__m256i returns) {
  const __m256i bytes =
      _mm256_setr_epi8(2, -1, -1, -1, 5, -1, -1, -1, 8, -1, -1, -1, 11, -1, -1, -1,  //
                       2, -1, -1, -1, 5, -1, -1, -1, 8, -1, -1, -1, 11, -1, -1, -1);
  return _mm256_shuffle_epi8(returns, bytes);
}

/// In which of the eight lanes all bits are set.
TRAVERSE_LANES unsigned lanes_of(__m256i truth) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(truth)));
}

TRAVERSE_LANES void store_ordered(float* to, __m256 values, __m256i order) {
  _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(values, order));
}

/// The same sums in the same order as one by one, without fused multiply-adds, so that the bits are
/// the same.
[[gnu::target("avx2,popcnt")]] ReturnCounts decode_by_eights(const BlockHead& head,
                                                             const BlockBeams& beams,
                                                             const std::uint8_t* returns,
                                                             const std::uint8_t* first,
                                                             const PointColumns& to) {
  const __m256 head_sin = _mm256_set1_ps(head.sin);
  const __m256 head_cos = _mm256_set1_ps(head.cos);
  const __m256 unit_m = _mm256_set1_ps(head.unit_m);
  const __m256 begin_s = _mm256_set1_ps(head.begin_s);
  const __m256 microsecond = _mm256_set1_ps(1e-6F);
  const __m256 minus = _mm256_set1_ps(-0.0F);
  const __m256i zero = _mm256_setzero_si256();
  unsigned came = 0;
  unsigned repeated = 0;
  std::size_t n = 0;
  for (std::size_t k = 0; k < kVelodyneReturns; k += kLanes) {
    const std::size_t at = k * kVelodyneReturnBytes;
    const __m256i eight = load_returns(returns + at);
    const __m256i units = distances_of(eight);
    unsigned set = ~lanes_of(_mm256_cmpeq_epi32(units, zero)) & 0xFFU;
    came += static_cast<unsigned>(__builtin_popcount(set));
    if (first != nullptr) {
      const __m256i before = distances_of(load_returns(first + at));
      const unsigned same = set & lanes_of(_mm256_cmpeq_epi32(units, before));
      repeated += static_cast<unsigned>(__builtin_popcount(same));
      set &= ~same;
    }
    const __m256 length = _mm256_add_ps(_mm256_mul_ps(_mm256_cvtepi32_ps(units), unit_m),
                                        _mm256_loadu_ps(beams.distance_m + k));
    const __m256 beam_sin = _mm256_loadu_ps(beams.sin_azimuth + k);
    const __m256 beam_cos = _mm256_loadu_ps(beams.cos_azimuth + k);
    const __m256 s =
        _mm256_add_ps(_mm256_mul_ps(head_sin, beam_cos), _mm256_mul_ps(head_cos, beam_sin));
    const __m256 c =
        _mm256_sub_ps(_mm256_mul_ps(head_cos, beam_cos), _mm256_mul_ps(head_sin, beam_sin));
    const __m256 up = _mm256_loadu_ps(beams.sin_elevation + k);
    const __m256 level = _mm256_loadu_ps(beams.cos_elevation + k);
    const __m256 across = _mm256_mul_ps(length, level);
    __m256 x = _mm256_mul_ps(across, c);
    __m256 y = _mm256_xor_ps(minus, _mm256_mul_ps(across, s));
    __m256 z = _mm256_mul_ps(length, up);
    if (beams.horizontal_m != nullptr) {
      const __m256 horizontal = _mm256_loadu_ps(beams.horizontal_m + k);
      const __m256 vertical = _mm256_loadu_ps(beams.vertical_m + k);
      const __m256 inwards = _mm256_mul_ps(vertical, up);
      x = _mm256_add_ps(x, _mm256_sub_ps(_mm256_mul_ps(horizontal, s), _mm256_mul_ps(inwards, c)));
      y = _mm256_add_ps(y, _mm256_add_ps(_mm256_mul_ps(horizontal, c), _mm256_mul_ps(inwards, s)));
      z = _mm256_add_ps(z, _mm256_mul_ps(vertical, level));
    }
    const __m256 time =
        _mm256_add_ps(begin_s, _mm256_mul_ps(_mm256_loadu_ps(beams.delay_us + k), microsecond));
    const __m256 intensity = _mm256_cvtepi32_ps(intensities_of(eight));

    const __m128i lanes =
        _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kLaneOrders.of[set].data()));
    const __m256i order = _mm256_cvtepu8_epi32(lanes);
    store_ordered(to.x + n, x, order);
    store_ordered(to.y + n, y, order);
    store_ordered(to.z + n, z, order);
    store_ordered(to.intensity + n, intensity, order);
    store_ordered(to.time + n, time, order);
    const __m128i low = _mm_add_epi8(lanes, lanes);
    const __m128i bytes = _mm_unpacklo_epi8(low, _mm_add_epi8(low, _mm_set1_epi8(1)));
    const __m128i ring = _mm_loadu_si128(reinterpret_cast<const __m128i*>(beams.ring + k));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to.ring + n), _mm_shuffle_epi8(ring, bytes));
    n += static_cast<std::size_t>(__builtin_popcount(set));
  }
  return {came, repeated, n};
}

const bool kHasAvx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt");

#endif

}  // namespace

ReturnCounts decode_block(const BlockHead& head, const BlockBeams& beams,
                          const std::uint8_t* returns, const std::uint8_t* first,
                          const PointColumns& to) {
#ifdef TRAVERSE_PACKETS_AVX2
  if (kHasAvx2) return decode_by_eights(head, beams, returns, first, to);
#endif
  return decode_block_one_by_one(head, beams, returns, first, to);
}

ReturnCounts decode_block_one_by_one(const BlockHead& head, const BlockBeams& beams,
                                     const std::uint8_t* returns, const std::uint8_t* first,
                                     const PointColumns& to) {
  ReturnCounts counts;
  for (std::size_t k = 0; k < kVelodyneReturns; ++k) {
    const std::uint8_t* at = returns + k * kVelodyneReturnBytes;
    const std::uint32_t units = u16_at(at);
    if (units == 0) continue;
    ++counts.returns;
    if (first != nullptr && u16_at(first + k * kVelodyneReturnBytes) == units) {
      ++counts.repeated;
      continue;
    }
    const float length = static_cast<float>(units) * head.unit_m + beams.distance_m[k];
    // Azimuths are clockwise from above.
    const float s = head.sin * beams.cos_azimuth[k] + head.cos * beams.sin_azimuth[k];
    const float c = head.cos * beams.cos_azimuth[k] - head.sin * beams.sin_azimuth[k];
    const float across = length * beams.cos_elevation[k];
    float x = across * c;
    float y = -(across * s);
    float z = length * beams.sin_elevation[k];
    if (beams.horizontal_m != nullptr) {
      const float inwards = beams.vertical_m[k] * beams.sin_elevation[k];
      x += beams.horizontal_m[k] * s - inwards * c;
      y += beams.horizontal_m[k] * c + inwards * s;
      z += beams.vertical_m[k] * beams.cos_elevation[k];
    }
    const std::size_t n = counts.points++;
    to.x[n] = x;
    to.y[n] = y;
    to.z[n] = z;
    to.intensity[n] = static_cast<float>(at[2]);
    to.time[n] = head.begin_s + beams.delay_us[k] * 1e-6F;
    to.ring[n] = beams.ring[k];
  }
  return counts;
}

}  // namespace traverse::packets
