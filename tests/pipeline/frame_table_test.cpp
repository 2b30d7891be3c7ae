#include "traverse/pipeline/frame_table.hpp"

#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::TemporaryFolder;

TEST(FrameTable, ReadsBackToTheSameBits) {
  const TemporaryFolder folder;
  FrameTable table({"frame", "rms_m"});
  table.add_row({0, 1.0 / 3});
  table.add_row({1, -1e-300});
  table.write_csv(folder / "frames.csv");
  const FrameTable read = FrameTable::read_csv(folder / "frames.csv");
  EXPECT_EQ(read.columns(), table.columns());
  EXPECT_EQ(read.rows(), table.rows());
  EXPECT_THAT(read.column("rms_m"), ElementsAre(1.0 / 3, -1e-300));
  EXPECT_THAT(read.column("none"), IsEmpty());
  EXPECT_FALSE(read.has("none"));
}

TEST(FrameTable, ARowMustFit) {
  FrameTable table({"a", "b"});
  EXPECT_THROW(table.add_row({1}), std::invalid_argument);
}

TEST(FrameTable, NamesTheLineThatIsWrong) {
  const TemporaryFolder folder;
  const auto line_of = [&](const std::string& text) {
    files::write_text(folder / "frames.csv", text);
    try {
      FrameTable::read_csv(folder / "frames.csv");
    } catch (const files::InputError& error) {
      return error.place().text;
    }
    return std::string("no error");
  };
  EXPECT_EQ(line_of("a,b\n1,2\n1,x\n"), "line 3");
  EXPECT_EQ(line_of("a,b\n1\n"), "line 2");
  EXPECT_NE(line_of(""), "no error");
}

}  // namespace
}  // namespace traverse::pipeline
