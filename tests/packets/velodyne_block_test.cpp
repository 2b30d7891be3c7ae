#include "velodyne_block.hpp"

#include <array>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace traverse::packets {
namespace {

constexpr std::size_t kRoom = kVelodyneReturns + kBlockSpill;

struct Points {
  std::array<float, kRoom> x{}, y{}, z{}, intensity{}, time{};
  std::array<std::uint16_t, kRoom> ring{};

  PointColumns columns() {
    return {x.data(), y.data(), z.data(), intensity.data(), time.data(), ring.data()};
  }
};

template <typename Column>
void expect_same_bits(const Column& a, const Column& b, std::size_t size) {
  EXPECT_EQ(std::memcmp(a.data(), b.data(), size * sizeof(a[0])), 0);
}

/// Returns as a sensor may send them: many firings meet nothing, seconds are often the firsts.
std::vector<std::uint8_t> draw_returns(std::mt19937& random, double nothing,
                                       const std::vector<std::uint8_t>& same_as) {
  std::vector<std::uint8_t> bytes(kVelodyneReturns * kVelodyneReturnBytes + 8);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() & 255);
  std::bernoulli_distribution is_nothing(nothing);
  std::bernoulli_distribution is_same(0.4);
  for (std::size_t k = 0; k < kVelodyneReturns; ++k) {
    const std::size_t at = k * kVelodyneReturnBytes;
    if (!same_as.empty() && is_same(random)) std::memcpy(&bytes[at], &same_as[at], 2);
    if (is_nothing(random)) bytes[at] = bytes[at + 1] = 0;
  }
  return bytes;
}

TEST(VelodyneBlock, EightAtOnceAreTheSameBitsAsOneByOne) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> draw(-1, 1);
  for (int trial = 0; trial < 400; ++trial) {
    std::array<std::array<float, kVelodyneReturns>, 8> numbers;
    for (auto& column : numbers) {
      for (float& number : column) number = draw(random);
    }
    std::array<std::uint16_t, kVelodyneReturns> rings;
    for (std::size_t k = 0; k < rings.size(); ++k) rings[k] = static_cast<std::uint16_t>(513 * k);
    const bool has_offsets = trial % 2 == 1;
    const BlockBeams beams{numbers[0].data(),
                           numbers[1].data(),
                           numbers[2].data(),
                           numbers[3].data(),
                           numbers[4].data(),
                           numbers[5].data(),
                           rings.data(),
                           has_offsets ? numbers[6].data() : nullptr,
                           has_offsets ? numbers[7].data() : nullptr};
    const BlockHead head{draw(random), draw(random), 0.002F, draw(random)};
    const double nothing = 0.1 * (trial % 11);
    const std::vector<std::uint8_t> first = draw_returns(random, nothing, {});
    const std::vector<std::uint8_t> returns = draw_returns(random, nothing, first);
    const std::uint8_t* const earlier = trial % 4 >= 2 ? first.data() : nullptr;

    Points eights;
    Points ones;
    const ReturnCounts counts =
        decode_block(head, beams, returns.data(), earlier, eights.columns());
    const ReturnCounts expected =
        decode_block_one_by_one(head, beams, returns.data(), earlier, ones.columns());
    ASSERT_EQ(counts.returns, expected.returns);
    ASSERT_EQ(counts.repeated, expected.repeated);
    ASSERT_EQ(counts.points, expected.points);
    EXPECT_EQ(counts.points + counts.repeated, counts.returns);
    expect_same_bits(eights.x, ones.x, counts.points);
    expect_same_bits(eights.y, ones.y, counts.points);
    expect_same_bits(eights.z, ones.z, counts.points);
    expect_same_bits(eights.intensity, ones.intensity, counts.points);
    expect_same_bits(eights.time, ones.time, counts.points);
    expect_same_bits(eights.ring, ones.ring, counts.points);
  }
}

}  // namespace
}  // namespace traverse::packets
