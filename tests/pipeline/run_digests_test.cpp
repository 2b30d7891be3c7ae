#include "traverse/pipeline/run_digests.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_record.hpp"

#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class RunDigests : public ::testing::Test {
 protected:
  RunDigests() {
    files::write_text(run_.trajectory(), "0 1 2 3 0 0 0 1\n");
    files::write_text(run_.frames(), "frame\n0\n");
    files::write_text(run_.report(), "<html>");
    files::write_text(folder_ / "notes.txt", "of the user");
    add_digests(run_, record_.files);
    write_record(run_, record_);
  }

  std::string error_of(const std::filesystem::path& file) const {
    try {
      require_as_written(run_, {file});
    } catch (const files::InputError& error) {
      return error.what();
    }
    return {};
  }

  testing::TemporaryFolder folder_;
  RunFolder run_{folder_.path()};
  RunRecord record_;
};

TEST_F(RunDigests, AreThoseOfTheFilesThatARunAloneWrites) {
  ASSERT_EQ(record_.files.size(), 2U);
  EXPECT_EQ(record_.files[0].name, "trajectory.tum");
  EXPECT_EQ(record_.files[0].bytes, 16U);
  EXPECT_EQ(record_.files[0].sha256, files::sha256_of_text("0 1 2 3 0 0 0 1\n"));
  EXPECT_EQ(record_.files[1].name, "frames.csv");
  EXPECT_EQ(error_of(run_.trajectory()), "");
  EXPECT_EQ(error_of(run_.frames()), "");
}

TEST_F(RunDigests, KnowOneThatComesLater) {
  files::write_text(run_.utm_trajectory(), "0 691000 5334000 520 0 0 0 1\n");
  EXPECT_THAT(error_of(run_.utm_trajectory()), HasSubstr("does not name"));
  add_digests(run_, record_.files);
  write_record(run_, record_);
  EXPECT_EQ(record_.files.size(), 3U);
  EXPECT_EQ(error_of(run_.utm_trajectory()), "");
}

TEST_F(RunDigests, TellOneThatWasChanged) {
  files::write_text(run_.trajectory(), "0 1 2 4 0 0 0 1\n");
  EXPECT_THAT(error_of(run_.trajectory()),
              AllOf(HasSubstr("trajectory.tum: expected"), HasSubstr("run.json"),
                    HasSubstr("16 bytes"), HasSubstr("edited"), HasSubstr("traverse run")));
  EXPECT_EQ(error_of(run_.frames()), "") << "the others can be read all the same";
  std::filesystem::remove(run_.trajectory());
  EXPECT_EQ(error_of(run_.trajectory()), "") << "who needs it will say so";
}

TEST_F(RunDigests, TellARecordThatWasChanged) {
  std::string json = files::read_text(run_.record());
  const std::size_t at = json.find("\"voxel_m\": 0.0");
  ASSERT_NE(at, std::string::npos);
  files::write_text(run_.record(), json.replace(at, 14, "\"voxel_m\": 0.1"));
  EXPECT_THAT(error_of(run_.frames()), AllOf(HasSubstr("run.json"), HasSubstr("edited")));
}

TEST_F(RunDigests, TheirOwnDigestCannotBeLeftOut) {
  std::string json = files::read_text(run_.record());
  const std::size_t begin = json.find('\n') + 1;
  json.erase(begin, json.find('\n', begin) + 1 - begin);
  files::write_text(run_.record(), json);
  EXPECT_THAT(error_of(run_.frames()),
              AllOf(HasSubstr("run.json"), HasSubstr("sha256_of_other_lines")));
}

TEST_F(RunDigests, EarlierVersionsWroteNone) {
  files::write_text(run_.record(), to_json(RunRecord(), build_info(), host_info()));
  files::write_text(run_.trajectory(), "0 1 2 4 0 0 0 1\n");
  EXPECT_EQ(error_of(run_.trajectory()), "");
  std::filesystem::remove(run_.record());
  EXPECT_EQ(error_of(run_.trajectory()), "");
}

}  // namespace
}  // namespace traverse::pipeline
