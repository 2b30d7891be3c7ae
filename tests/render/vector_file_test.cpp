#include "traverse/render/vector_file.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::render {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Drawing lines() {
  Drawing drawing;
  drawing.width = 200;
  drawing.height = 100;
  drawing.background = Colour::hex(0xFFFFFF);
  Polyline line;
  line.points = {
      {10, 10}, {50, 50}, {std::numeric_limits<double>::quiet_NaN(), 0}, {60, 10}, {90, 90}};
  line.colour = Colour::hex(0x0072B2);
  line.dashes = {4, 2};
  drawing.items.push_back({line, Rect{0, 0, 80, 80}});
  drawing.items.push_back({Disc{{150, 50}, 10, Colour::hex(0xD55E00)}, std::nullopt});
  drawing.items.push_back(
      {Polygon{{{110, 10}, {130, 10}, {120, 30}}, Colour::hex(0x009E73), 0.5}, std::nullopt});
  drawing.texts.push_back({"x < y & µ",
                           {10, 90},
                           16,
                           FontWeight::kBold,
                           HorizontalAlign::kLeft,
                           Colour::hex(0),
                           Colour::hex(0xFFFFFF)});
  return drawing;
}

TEST(VectorFile, SvgHasTheSizeAndTheColours) {
  const std::string svg = encode_svg(lines());
  EXPECT_THAT(svg, StartsWith("<?xml"));
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 200 100\""));
  EXPECT_THAT(svg, HasSubstr("44.70588"));
  EXPECT_THAT(svg, HasSubstr("clip"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(VectorFile, PdfIsOnePage) {
  const std::string pdf = encode_pdf(lines());
  EXPECT_THAT(pdf, StartsWith("%PDF-"));
  EXPECT_THAT(pdf, HasSubstr("/Count 1"));
}

TEST(VectorFile, APointCloudIsNoVectorGraphic) {
  Drawing drawing = lines();
  EXPECT_TRUE(is_vector(drawing));
  drawing.items.push_back({PointCloud{}, std::nullopt});
  EXPECT_FALSE(is_vector(drawing));
  EXPECT_THROW(encode_svg(drawing), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::render
