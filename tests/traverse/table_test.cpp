#include "table.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace traverse::app {
namespace {

TEST(Table, AlignsColumnsByWhatTheTerminalShows) {
  Table table({{}, {Table::Align::kRight}, {}});
  table.add_row({"name", "n", "note"});
  table.add_row({"µm", "12", ""});
  table.add_row({"long name", "3", "x"});
  EXPECT_EQ(table.text(2),
            "  name        n  note\n"
            "  µm         12\n"
            "  long name   3  x\n");
  EXPECT_THROW(table.add_row({"one"}), std::invalid_argument);
}

TEST(Table, BreaksWideCellsBetweenWords) {
  Table table({{}, {Table::Align::kLeft, 9}});
  table.add_row({"a", "one two three"});
  table.add_row({"b", "unbreakable"});
  EXPECT_EQ(table.text(0),
            "a  one two\n"
            "   three\n"
            "b  unbreakable\n");
}

}  // namespace
}  // namespace traverse::app
