#include "page/exports.hpp"

#include <gtest/gtest.h>

#include "page/html_table.hpp"

namespace traverse::report {
namespace {

HtmlTable table() {
  HtmlTable result("t", "A table", {"name", "share [%]", "count"});
  result.add_row({"a, \"b\"", 1.0 / 3, Cell::count(12345)});
  result.add_row({"50 % of x_1 & {<}", -2.5, Cell::count(1)});
  return result;
}

TEST(Csv, KeepsEveryDigitAndQuotesAsTheStandardSays) {
  EXPECT_EQ(to_csv(table().json()),
            "name,share [%],count\r\n"
            "\"a, \"\"b\"\"\",0.3333333333333333,12345\r\n"
            "50 % of x_1 & {<},-2.5,1\r\n");
}

TEST(Csv, NothingThatASpreadsheetComputes) {
  HtmlTable result("t", "A table", {"name", "=1+1"});
  result.add_row({"=cmd|'/c calc'!A1", -2.5});
  EXPECT_EQ(to_csv(result.json()), "name,\"'=1+1\"\r\n\"'=cmd|'/c calc'!A1\",-2.5\r\n");
}

TEST(Latex, EscapesWhatLatexWouldTakeForItself) {
  EXPECT_EQ(to_latex(table().json()),
            "% A table; needs \\usepackage{booktabs}\n\\begin{tabular}{lrr}\n\\toprule\n"
            "name & share [\\%] & count \\\\\n\\midrule\n"
            "a, \"b\" & 0.333 & 12345 \\\\\n"
            "50 \\% of x\\_1 \\& \\{\\textless{}\\} & $-$2.50 & 1 \\\\\n"
            "\\bottomrule\n\\end{tabular}\n");
}

}  // namespace
}  // namespace traverse::report
