#include "traverse/files/latex.hpp"

#include <gtest/gtest.h>

namespace traverse::files {
namespace {

TEST(LatexText, EscapesWhatLatexWouldTakeForItself) {
  EXPECT_EQ(latex_text("a & b % c $ d # e _ f { g }"), "a \\& b \\% c \\$ d \\# e \\_ f \\{ g \\}");
  EXPECT_EQ(latex_text("\\input{~/x^2}<>"),
            "\\textbackslash{}input\\{\\textasciitilde{}/x\\textasciicircum{}2\\}\\textless{}"
            "\\textgreater{}");
  EXPECT_EQ(latex_text("two\nlines\r"), "two lines ");
}

}  // namespace
}  // namespace traverse::files
