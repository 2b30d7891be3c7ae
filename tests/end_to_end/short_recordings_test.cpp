#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/recording_writer.hpp"

#include "dataset/made_recordings.hpp"
#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

/// Recordings so short that a median has one value, a graph one node and a path no length: `run`
/// ends with a status, and where that is not success with a message.
namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

/// The names of the files in a folder of share/, without their ending.
std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(TRAVERSE_SHARE_DIR) / folder)) {
    names.push_back(entry.path().stem().string());
  }
  return names;
}

void make_recording(const std::string& arguments, const fs::path& rawlog) {
  const ProgramResult made =
      run_program("simulate " + arguments + " --sensor vlp16 -o " + quoted(rawlog));
  ASSERT_EQ(made.status, 0) << arguments << '\n' << made.messages;
}

/// The last of the lines, each of which may have written over itself.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.find_last_of("\r\n") + 1);
}

/// A status of its own, not a signal's, and where that is 1 a reason.
void run_ends_well(const fs::path& recording, const std::string& options) {
  const TemporaryFolder folder;
  const ProgramResult ran = run_program("run " + quoted(recording) + " --no-hash " + options +
                                        " -o " + quoted(folder / "run"));
  const std::string what = recording.filename().string() + " " + options;
  EXPECT_TRUE(ran.status == 0 || ran.status == 1) << what << ": " << ran.status << '\n'
                                                  << ran.everything();
  if (ran.status == 1) {
    const std::string said = last_line(ran.messages);
    EXPECT_THAT(said, HasSubstr("traverse: ")) << what;
    EXPECT_GT(said.size(), 30U) << what << ": " << said;
  }
}

/// A recording's measurements, written again as `change` wants them.
void rewrite(const fs::path& from, const fs::path& to, const auto& change) {
  const auto source = testing::open(from);
  const std::vector<sensors::Measurement> all = testing::read_all(*source);
  const auto writer = dataset::write_rawlog(to, source->info(), source->reference(), {});
  change(all, *writer);
  writer->commit();
}

TEST(ShortRecordings, ASecondOfEveryWorldByTheDefaultPreset) {
  const TemporaryFolder folder;
  for (const std::string& world : names_in("worlds")) {
    const fs::path rawlog = folder / (world + ".rawlog");
    make_recording(world + " --duration 1", rawlog);
    run_ends_well(rawlog, "--no-report");
  }
}

TEST(ShortRecordings, ASecondByEveryPreset) {
  const TemporaryFolder folder;
  const fs::path rawlog = folder / "park.rawlog";
  make_recording("park --duration 1", rawlog);
  for (const std::string& preset : names_in("pipelines")) {
    run_ends_well(rawlog, "--no-report --pipeline " + preset);
  }
}

/// With other sensors and without; of a single frame there is a report, too.
TEST(ShortRecordings, AFewFrames) {
  const TemporaryFolder folder;
  for (const int frames : {1, 2, 3, 5}) {
    for (const bool has_others : {true, false}) {
      const fs::path rawlog = folder / (std::to_string(frames) + ".rawlog");
      make_recording("corridor_loop --first 30 --last " + std::to_string(29 + frames) +
                         (has_others ? " --set gnss.mounted=true"
                                     : " --set imu.mounted=false --set wheels.mounted=false"),
                     rawlog);
      run_ends_well(rawlog, has_others && frames == 1 ? "" : "--no-report");
      if (has_others) run_ends_well(rawlog, "--no-report --pipeline loam");
    }
  }
}

/// One scan again and again, as a driver that hangs writes it; the IMU goes on or is not there.
TEST(ShortRecordings, OneFrameRepeated) {
  const TemporaryFolder folder;
  const fs::path once = folder / "once.rawlog";
  make_recording("corridor_loop --first 30 --duration 1 --set gnss.mounted=true", once);
  for (const bool stamps_increase : {true, false}) {
    for (const bool has_others : {true, false}) {
      const fs::path repeated = folder / "repeated.rawlog";
      rewrite(once, repeated, [&](const auto& all, dataset::RecordingWriter& writer) {
        std::shared_ptr<const sensors::LidarScan> first;
        for (const sensors::Measurement& measurement : all) {
          const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement);
          if (scan == nullptr) {
            if (has_others) writer.add(measurement);
            continue;
          }
          if (first == nullptr) first = *scan;
          auto again = std::make_shared<sensors::LidarScan>(*first);
          if (stamps_increase) again->stamp = (*scan)->stamp;
          writer.add(sensors::Measurement(std::shared_ptr<const sensors::LidarScan>(again)));
        }
      });
      for (const std::string preset : {"traverse", "loam", "floam"}) {
        run_ends_well(repeated, "--no-report --pipeline " + preset);
      }
    }
  }
}

TEST(ShortRecordings, AVehicleThatNeverMoves) {
  const TemporaryFolder folder;
  for (const bool has_others : {true, false}) {
    const fs::path rawlog = folder / "still.rawlog";
    make_recording(
        "park --duration 2 --set route.standstill_s=5" +
            std::string(has_others ? ""
                                   : " --set imu.mounted=false --set wheels.mounted=false "
                                     "--set gnss.mounted=false"),
        rawlog);
    run_ends_well(rawlog, has_others ? "" : "--no-report");
    const std::vector<std::string> without{"aloam", "loam", "gins-window"};
    for (const std::string& preset : has_others ? names_in("pipelines") : without) {
      run_ends_well(rawlog, "--no-report --pipeline " + preset);
    }
  }
}

}  // namespace
}  // namespace traverse
