#include "traverse/files/csv.hpp"

#include <gtest/gtest.h>

namespace traverse::files {
namespace {

TEST(CsvCell, IsQuotedWhereTheStandardSays) {
  EXPECT_EQ(csv_cell(""), "");
  EXPECT_EQ(csv_cell("plain text; 50 %"), "plain text; 50 %");
  EXPECT_EQ(csv_cell("a, b"), "\"a, b\"");
  EXPECT_EQ(csv_cell("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csv_cell("two\nlines"), "\"two\nlines\"");
  EXPECT_EQ(csv_cell("two\r\nlines"), "\"two\r\nlines\"");
}

TEST(CsvCell, IsNothingThatASpreadsheetComputes) {
  EXPECT_EQ(csv_cell("=cmd|'/c calc'!A1"), "\"'=cmd|'/c calc'!A1\"");
  EXPECT_EQ(csv_cell("+1+2"), "\"'+1+2\"");
  EXPECT_EQ(csv_cell("-1+2"), "\"'-1+2\"");
  EXPECT_EQ(csv_cell("@SUM(A1)"), "\"'@SUM(A1)\"");
  EXPECT_EQ(csv_cell("\t=1"), "\"'\t=1\"");
  EXPECT_EQ(csv_cell("\r=1"), "\"'\r=1\"");
  EXPECT_EQ(csv_cell("\n=1"), "\"'\n=1\"");
  EXPECT_EQ(csv_cell("=\"a\""), "\"'=\"\"a\"\"\"");
}

TEST(CsvCell, NumbersStayNumbers) {
  for (const char* number : {"-1.5", "+2", "1e-05", "-3.25e+100", "nan", "-inf", "-7"}) {
    EXPECT_EQ(csv_cell(number), number);
  }
}

}  // namespace
}  // namespace traverse::files
