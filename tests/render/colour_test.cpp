#include "traverse/render/colour.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "traverse/render/colour_map.hpp"
#include "traverse/render/palette.hpp"
#include "traverse/render/theme.hpp"

#include "plot/colour_scale.hpp"

namespace traverse::render {
namespace {

/// CIE L* of a colour: its contrast against black gives its luminance.
double lightness(Colour colour) {
  const double luminance = contrast_ratio(colour, Colour{}) * 0.05 - 0.05;
  return 116 * std::cbrt(luminance) - 16;
}

TEST(ContrastRatio, SpansOneToTwentyOne) {
  EXPECT_DOUBLE_EQ(contrast_ratio(Colour::hex(0xFFFFFF), Colour::hex(0x000000)), 21);
  EXPECT_DOUBLE_EQ(contrast_ratio(palette::kBlue, palette::kBlue), 1);
}

TEST(Theme, TextCanBeReadInBoth) {
  for (const Theme& theme : {light_theme(), dark_theme()}) {
    EXPECT_GT(contrast_ratio(theme.text, theme.background), 10);
    EXPECT_GT(contrast_ratio(theme.muted, theme.background), 4.5);
    EXPECT_GT(contrast_ratio(theme.reference, theme.background), 4.5);
    EXPECT_GT(contrast_ratio(palette::series(0), theme.background), 3);
    EXPECT_LT(contrast_ratio(theme.grid, theme.background), 1.5);
  }
}

TEST(ColourMap, MatchesThePublishedTables) {
  EXPECT_EQ(colour_at(ColourMap::kViridis, 0), Colour::hex(0x440154));
  EXPECT_EQ(colour_at(ColourMap::kViridis, 0.5), Colour::hex(0x21918C));
  EXPECT_EQ(colour_at(ColourMap::kViridis, 1), Colour::hex(0xFDE725));
  EXPECT_EQ(colour_at(ColourMap::kCividis, 0), Colour::hex(0x00224E));
  EXPECT_EQ(colour_at(ColourMap::kCividis, 1), Colour::hex(0xFEE838));
}

TEST(ColourMap, GetsLighterAllTheWay) {
  for (const ColourMap map : {ColourMap::kViridis, ColourMap::kCividis}) {
    for (int i = 4; i < 256; ++i) {
      EXPECT_GT(lightness(colour_at(map, (i + 0.5) / 256)),
                lightness(colour_at(map, (i - 3.5) / 256)))
          << i;
    }
  }
}

TEST(ColourMap, DivergesFromWhiteAtZeroToEqualDarkness) {
  EXPECT_EQ(colour_at(ColourMap::kDiverging, 0.5), Colour::hex(0xFFFFFF));
  for (const double share : {0.0, 0.1, 0.25, 0.4}) {
    EXPECT_NEAR(lightness(colour_at(ColourMap::kDiverging, share)),
                lightness(colour_at(ColourMap::kDiverging, 1 - share)), 3)
        << share;
    EXPECT_LT(lightness(colour_at(ColourMap::kDiverging, share)), 90);
  }
}

TEST(ColourMap, StaysInItsTableForAnyNumber) {
  EXPECT_EQ(colour_at(ColourMap::kViridis, -5), colour_at(ColourMap::kViridis, 0));
  EXPECT_EQ(colour_at(ColourMap::kViridis, 1e300), colour_at(ColourMap::kViridis, 1));
  EXPECT_EQ(colour_at(ColourMap::kViridis, std::nan("")), Colour::hex(0x808080));
}

TEST(ColourScale, ClipsAtThePercentilesAndKnowsIt) {
  std::vector<double> values(101);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  values.back() = 1e6;
  const ColourScale scale = colour_scale(values, ColourMap::kViridis);
  EXPECT_DOUBLE_EQ(scale.shown.low, 2);
  EXPECT_DOUBLE_EQ(scale.shown.high, 98);
  EXPECT_EQ(scale.data.high, 1e6);
  EXPECT_TRUE(scale.clipped());
  EXPECT_EQ(scale(1e6), colour_at(ColourMap::kViridis, 1));
}

TEST(ColourScale, IsSymmetricalForSignedValues) {
  const std::vector<double> values{-1, 3};
  const ColourScale scale = colour_scale(values, ColourMap::kDiverging);
  EXPECT_EQ(scale.shown.low, -scale.shown.high);
  EXPECT_EQ(scale(0), Colour::hex(0xFFFFFF));
}

TEST(ColourScale, HasASpanEvenIfAllValuesAreEqualOrMissing) {
  EXPECT_GT(colour_scale(std::vector<double>(5, 0.25), ColourMap::kViridis).shown.span(), 0);
  EXPECT_GT(colour_scale(std::vector<double>{}, ColourMap::kViridis).shown.span(), 0);
  EXPECT_FALSE(colour_scale(std::vector<double>(5, 0.25), ColourMap::kViridis).clipped());
}

}  // namespace
}  // namespace traverse::render
