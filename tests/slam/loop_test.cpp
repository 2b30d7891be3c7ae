#include "traverse/slam/loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/geometry/so3.hpp"

#include "temporary_folder.hpp"

namespace traverse::slam {
namespace {

Loop example() {
  Loop loop;
  loop.keyframe = 240;
  loop.candidate = 12;
  loop.stamp = {1'700'000'000'123'456'789};
  loop.candidate_stamp = {1'600'000'000'000'000'001};
  loop.source = LoopSource::kAppearance;
  loop.verdict = LoopVerdict::kOdometry;
  loop.T_candidate_keyframe.rotation = geometry::exp_so3({0.1, -0.2, 3});
  loop.T_candidate_keyframe.translation = {1.5, -2.25, 0.125};
  loop.overlap = 0.75;
  loop.weight = 0.5;
  return loop;
}

TEST(Loops, ReadBackAsWritten) {
  const testing::TemporaryFolder folder;
  const std::vector<Loop> loops{example(), Loop{}};
  write_loops(folder / "loops.csv", loops);
  const std::vector<Loop> read = read_loops(folder / "loops.csv");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].keyframe, 240U);
  EXPECT_EQ(read[0].candidate, 12U);
  EXPECT_EQ(read[0].stamp, example().stamp);
  EXPECT_EQ(read[0].candidate_stamp, example().candidate_stamp);
  EXPECT_EQ(read[0].source, LoopSource::kAppearance);
  EXPECT_EQ(read[0].verdict, LoopVerdict::kOdometry);
  EXPECT_EQ(read[0].overlap, 0.75);
  EXPECT_EQ(read[0].weight, 0.5);
  EXPECT_TRUE(read[0].T_candidate_keyframe.matrix().isApprox(
      example().T_candidate_keyframe.matrix(), 1e-12));
  EXPECT_EQ(read[1].verdict, LoopVerdict::kNotRegistered);
}

TEST(Loops, AWrongVerdictIsNamedWithItsLine) {
  const testing::TemporaryFolder folder;
  write_loops(folder / "loops.csv", std::vector<Loop>{example()});
  const std::string whole = files::read_text(folder / "loops.csv");
  const std::string head = whole.substr(0, whole.find('\n') + 1);
  files::write_text(folder / "bad.csv", head + "3,1.5,2,0.5,position,perhaps\n");
  try {
    read_loops(folder / "bad.csv");
    FAIL() << "read";
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("line 2"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("'perhaps'"));
  }
  files::write_text(folder / "cut.csv", head.substr(0, head.size() / 2));
  EXPECT_THROW(read_loops(folder / "cut.csv"), files::InputError) << "of columns";
}

}  // namespace
}  // namespace traverse::slam
