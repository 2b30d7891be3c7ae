#include "text_measure.hpp"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "plot/wrapped.hpp"
#include "temporary_folder.hpp"

namespace traverse::render {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using traverse::testing::TemporaryFolder;

constexpr auto kRegular = FontWeight::kRegular;

TEST(TextMeasure, GrowsWithTextAndSize) {
  const TextMeasure measure;
  const double two_digits = measure.width("0000", 20, kRegular) - measure.width("00", 20, kRegular);
  EXPECT_NEAR(two_digits, 2 * 0.636 * 20, 0.5);  // DejaVu's digits are 0.636 em wide
  EXPECT_NEAR(measure.width("±°µ²–", 40, kRegular), 2 * measure.width("±°µ²–", 20, kRegular), 2);
  EXPECT_GT(measure.width("mm", 20, FontWeight::kBold), measure.width("mm", 20, kRegular));
  EXPECT_EQ(measure.width("", 20, kRegular), 0);
  EXPECT_EQ(measure.width("   ", 20, kRegular), 0);
}

TEST(TextMeasure, BoxHangsOnItsAnchorAsAligned) {
  const TextMeasure measure;
  Text text{"abc", {100, 50}, 20, kRegular, HorizontalAlign::kRight, {}, {}};
  EXPECT_EQ(measure.box(text).right, 100);
  text.align = HorizontalAlign::kCentre;
  EXPECT_DOUBLE_EQ(measure.box(text).centre().x, 100);
  EXPECT_LT(measure.box(text).top, 50 - 14);
  EXPECT_GT(measure.box(text).bottom, 50);
}

TEST(TextMeasure, ShortensInTheMiddleUntilItFits) {
  const TextMeasure measure;
  const std::string name = "2011_09_26_drive_0001_sync_and_more_of_it";
  const std::string fitted = measure.fitted(name, 16, kRegular, 150);
  EXPECT_LE(measure.width(fitted, 16, kRegular), 150);
  EXPECT_GT(measure.width(fitted, 16, kRegular), 120);
  EXPECT_THAT(fitted, HasSubstr("…"));
  EXPECT_EQ(fitted.substr(0, 4), "2011");
  EXPECT_EQ(fitted.back(), 't');
  EXPECT_EQ(measure.fitted("abc", 16, kRegular, 150), "abc");
  EXPECT_EQ(measure.fitted(name, 16, kRegular, 5), "");
}

TEST(Printable, ReplacesWhatIsNoText) {
  EXPECT_EQ(printable("a\tb\n"), "a b ");
  EXPECT_EQ(printable("\xff"
                      "a\xc3"),
            "\uFFFD"
            "a\uFFFD");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\uFFFD\uFFFD\uFFFD");  // half a surrogate pair
  EXPECT_EQ(printable("\xc0\xaf"), "\uFFFD\uFFFD");            // '/' in too many bytes
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(printable("µ²–東😀"), "µ²–東😀");
}

TEST(Wrapped, BreaksAtBlanksOnly) {
  const TextMeasure measure;
  const double width = measure.width("one two", 16, kRegular) + 1;
  EXPECT_THAT(wrapped(measure, "one two three", 16, width), ElementsAre("one two", "three"));
  EXPECT_TRUE(wrapped(measure, "", 16, width).empty());
  EXPECT_THAT(wrapped(measure, "a  Donaudampfschifffahrtsgesellschaft", 16, width),
              ElementsAre("a", HasSubstr("…")));
}

TEST(FontFile, TheChosenFolderComesFirst) {
  const TemporaryFolder folder;
  files::write_text(folder / "DejaVuSans.ttf", "");
  ASSERT_EQ(::setenv("TRAVERSE_FONTS", folder.path().c_str(), 1), 0);
  EXPECT_EQ(font_file(kRegular, font_folders()), folder / "DejaVuSans.ttf");
  EXPECT_NE(font_file(FontWeight::kBold, font_folders()).parent_path(), folder.path());
  ASSERT_EQ(::unsetenv("TRAVERSE_FONTS"), 0);
}

TEST(FontFile, AMissingFontSaysWhereItWasLookedForAndWhatToInstall) {
  const TemporaryFolder folder;
  try {
    font_file(FontWeight::kBold, {folder.path(), "/no/such/folder"});
    FAIL() << "no error";
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("DejaVuSans-Bold.ttf"));
    EXPECT_THAT(error.what(), HasSubstr(folder.path().string() + ", /no/such/folder"));
    EXPECT_THAT(error.what(), HasSubstr("fonts-dejavu-core"));
  }
}

}  // namespace
}  // namespace traverse::render
