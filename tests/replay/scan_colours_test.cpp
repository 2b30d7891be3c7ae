#include "traverse/replay/scan_colours.hpp"

#include <gtest/gtest.h>

#include "traverse/render/palette.hpp"

namespace traverse::replay {
namespace {

/// Heights 0, 1, ... 100 m, all flat; rings, times and intensities are not known.
ShownScan tower() {
  ShownScan scan;
  for (int i = 0; i <= 100; ++i) scan.points_body.emplace_back(0, 0, i);
  scan.feature_class.assign(scan.points_body.size(), 3);
  return scan;
}

TEST(ScanColours, SpanFromTheSecondToTheNinetyEighthPercentile) {
  const ScanColours found = colours_of(tower(), ScanColour::kHeight);
  ASSERT_EQ(found.colours.size(), 101U);
  EXPECT_EQ(found.legend.title, "height [m], 2nd to 98th percentile");
  EXPECT_EQ(found.legend.labels, (std::vector<std::string>{"2", "98"}));
  EXPECT_EQ(found.colours.front(), found.legend.samples.front());
  EXPECT_EQ(found.colours.back(), found.legend.samples.back());
  EXPECT_NE(found.colours[50], found.colours[80]);
}

TEST(ScanColours, EveryClassHasItsLabel) {
  const ScanColours found = colours_of(tower(), ScanColour::kClass);
  EXPECT_EQ(found.legend.labels.size(), found.legend.samples.size());
  EXPECT_EQ(found.legend.labels[3], "flat");
  for (const auto colour : found.colours) EXPECT_EQ(colour, found.legend.samples[3]);
}

TEST(ScanColours, SayWhatTheScanDoesNotHold) {
  for (const ScanColour by : {ScanColour::kRing, ScanColour::kTime, ScanColour::kIntensity}) {
    const ScanColours found = colours_of(tower(), by);
    EXPECT_EQ(found.colours.size(), 101U);
    EXPECT_NE(found.legend.title.find("not known for this scan"), std::string::npos);
    EXPECT_TRUE(found.legend.samples.empty());
  }
}

TEST(ScanColours, ResidualsHaveASign) {
  EXPECT_EQ(residual_colour(0.5), residual_colour(kResidualScale));
  EXPECT_NE(residual_colour(0.05), residual_colour(-0.05));
  const ColourLegend legend = colours_of(tower(), ScanColour::kResidual).legend;
  EXPECT_EQ(legend.samples.front(), residual_colour(-kResidualScale));
  EXPECT_EQ(legend.samples.back(), residual_colour(kResidualScale));
  EXPECT_EQ(legend.labels, (std::vector<std::string>{"-0.1", "0.1"}));
}

}  // namespace
}  // namespace traverse::replay
