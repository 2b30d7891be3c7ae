#include <cmath>

#include <gtest/gtest.h>

#include "traverse/page/table.hpp"

namespace traverse::page {
namespace {

Table table() {
  Table result("t", "A table", {"name", "share [%]", "count"});
  result.add_row({"a, \"b\"", 1.0 / 3, Cell::count(12345)});
  result.add_row({"50 % of x_1 & {<}", -2.5, Cell::count(1)});
  return result;
}

TEST(Csv, KeepsEveryDigitAndQuotesAsTheStandardSays) {
  EXPECT_EQ(to_csv(table()),
            "name,share [%],count\r\n"
            "\"a, \"\"b\"\"\",0.3333333333333333,12345\r\n"
            "50 % of x_1 & {<},-2.5,1\r\n");
}

TEST(Csv, NothingThatASpreadsheetComputes) {
  Table result("t", "A table", {"name", "=1+1"});
  result.add_row({"=cmd|'/c calc'!A1", -2.5});
  EXPECT_EQ(to_csv(result), "name,\"'=1+1\"\r\n\"'=cmd|'/c calc'!A1\",-2.5\r\n");
}

TEST(Latex, EscapesWhatLatexWouldTakeForItself) {
  EXPECT_EQ(to_latex(table()),
            "% A table; needs \\usepackage{booktabs}\n\\begin{tabular}{lrr}\n\\toprule\n"
            "name & share [\\%] & count \\\\\n\\midrule\n"
            "a, \"b\" & 0.333 & 12345 \\\\\n"
            "50 \\% of x\\_1 \\& \\{\\textless{}\\} & $-$2.50 & 1 \\\\\n"
            "\\bottomrule\n\\end{tabular}\n");
}

TEST(Latex, ShowsNumbersAsThePageDoes) {
  Table result("t", "A table", {"value"});
  Cell spread(50.0);
  spread.text += " ± 2.0";
  result.add_row({spread});
  result.add_row({std::nan("")});
  EXPECT_NE(to_latex(result).find("50.0 $\\pm$ 2.0 \\\\\n-- \\\\"), std::string::npos)
      << to_latex(result);
}

TEST(Markdown, IsOneLinePerRowAndTheBestIsBold) {
  Table result = table();
  result.add_row({"a|b", std::nan(""), Cell::count(2)});
  result.mark_best({1});
  EXPECT_EQ(to_markdown(result),
            "| name | share [%] | count |\n|---|---|---|\n"
            "| a, \"b\" | 0.333 | 12345 |\n"
            "| 50 % of x_1 & {<} | **-2.50** | 1 |\n"
            "| a\\|b | - | 2 |\n");
}

TEST(Text, StandsInColumns) {
  EXPECT_EQ(to_text(table()),
            "A table\n"
            "  name               share [%]   count\n"
            "  a, \"b\"                 0.333  12\u2009345\n"
            "  50 % of x_1 & {<}      \u22122.50       1\n");
}

TEST(Cell, HasSoManyDecimalsWhereItIsAsked) {
  EXPECT_EQ(Cell::fixed(-1.23456, 3).text, "\u22121.235");
  EXPECT_EQ(Cell::fixed(-1.23456, 3).full, "-1.23456");
  EXPECT_EQ(Cell::fixed(std::nan(""), 3).text, "\u2013");
}

}  // namespace
}  // namespace traverse::page
