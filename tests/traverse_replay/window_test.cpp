#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/imported_poses.hpp"
#include "traverse/pipeline/run.hpp"
#include "traverse/replay/recording.hpp"

#include "replay/simulated_rawlog.hpp"
#include "temporary_folder.hpp"
#include "traverse_replay/screen.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using testing::eventually;
using ::testing::HasSubstr;
using testing::WindowedProgram;

constexpr int kWidth = 1000;
constexpr int kHeight = 700;
constexpr std::size_t kFrames = 40;

// Where things are in a window of this size.
constexpr testing::Place kPresetBox{850, 378};
constexpr testing::Place kFirstPreset{740, 370};  // of the list that the box opens
constexpr testing::Place kRestartHere{780, 465};

/// Real key presses and clicks; the frame on show is told by the name of a screenshot.
class WindowTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new testing::TemporaryFolder();
    testing::write_simulated_rawlog(*shared_ / "street.rawlog", kFrames);
  }
  static void TearDownTestSuite() { delete shared_; }

  void SetUp() override {
    for (const char* program : {"Xvfb", "xdotool"}) {
      if (!testing::is_installed(program)) {
        GTEST_SKIP() << program << " is not installed: no window can be opened";
      }
    }
    screen_ = std::make_unique<testing::Screen>(folder_.path());
  }

  static std::string arguments(const std::string& more = "") {
    return fmt::format("'{}' --width {} --height {} --no-index-cache {}",
                       (*shared_ / "street.rawlog").string(), kWidth, kHeight, more);
  }

  std::size_t pictures() const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      count += entry.path().extension() == ".png" ? 1 : 0;
    }
    return count;
  }

  /// The frame on show, from the name of a screenshot that is taken now.
  int frame(WindowedProgram& program) {
    const std::size_t before = pictures();
    program.press("s");
    if (!eventually([&] { return pictures() > before || program.has_ended(); })) return -1;
    fs::path newest;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().extension() != ".png") continue;
      if (newest.empty() || entry.last_write_time() > fs::last_write_time(newest)) {
        newest = entry.path();
      }
    }
    const std::string name = newest.stem().string();
    const std::size_t at = name.find("frame-");
    return at == std::string::npos ? -1 : std::stoi(name.substr(at + 6, 6));
  }
  bool shows(WindowedProgram& program, int wanted) {
    return eventually([&] { return program.has_ended() || frame(program) == wanted; }, 60);
  }

  static testing::TemporaryFolder* shared_;
  testing::TemporaryFolder folder_;
  std::unique_ptr<testing::Screen> screen_;
};

testing::TemporaryFolder* WindowTest::shared_ = nullptr;

TEST_F(WindowTest, ObeysKeysAndMouse) {
  WindowedProgram program(*screen_, folder_.path(), arguments());
  ASSERT_TRUE(program.has_window()) << program.messages();
  EXPECT_TRUE(shows(program, 0));

  program.press("Right Right Right");
  EXPECT_TRUE(shows(program, 3)) << "three steps";
  program.press("shift+Right");
  EXPECT_TRUE(shows(program, 13)) << "ten steps";
  program.press("Left");
  EXPECT_TRUE(shows(program, 12)) << "one step back";
  program.press("End");
  EXPECT_TRUE(shows(program, kFrames - 1)) << "end";
  program.press("Home");
  EXPECT_TRUE(shows(program, 0)) << "home";

  program.press("bracketright bracketright");  // four times real time
  program.press("space");
  EXPECT_TRUE(eventually([&] { return frame(program) > 5; })) << "play";
  program.press("space");
  const int paused = frame(program);
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  EXPECT_NEAR(frame(program), paused, 4) << "pause";  // the few that were on their way

  program.click({(kWidth - 24) / 2 + 12, kHeight - 88 + 19});  // the middle of the time line
  EXPECT_TRUE(eventually([&] { return std::abs(frame(program) - 20) <= 1; })) << "seek by mouse";

  program.press("g");
  program.press("1 7 Return");
  EXPECT_TRUE(shows(program, 17)) << "typed";
  const int origin = frame(program);
  program.press("r");  // the pipeline begins again at this frame
  program.press("Home");
  EXPECT_TRUE(shows(program, origin)) << "restarted here: nothing before";

  for (const char* key : {"t", "v", "f", "c", "c", "3", "4", "h", "h", "l", "i", "o", "p"}) {
    program.press(key);
  }
  program.press("ctrl+s");
  EXPECT_TRUE(eventually([&] {
    return fs::exists(folder_.path() / fmt::format("street-frame-{:06}/trajectory.tum", origin));
  })) << "saved";
  program.press("q");
  EXPECT_EQ(program.exit_status(), 0) << program.messages();
  EXPECT_EQ(program.messages(), "");
}

TEST_F(WindowTest, ChangesThePipelineByMouse) {
  WindowedProgram program(*screen_, folder_.path(), arguments("--at 9"));
  ASSERT_TRUE(program.has_window()) << program.messages();
  ASSERT_TRUE(shows(program, 9));
  EXPECT_THAT(program.title(), HasSubstr("(traverse)"));
  program.click(kPresetBox);
  program.click(kFirstPreset);
  EXPECT_THAT(program.title(), HasSubstr("(traverse)")) << "chosen, not yet begun";
  program.click(kRestartHere);
  EXPECT_TRUE(eventually([&] { return program.title().find("(aloam)") != std::string::npos; }))
      << program.title();
  EXPECT_TRUE(shows(program, 9));
  program.press("Home");
  EXPECT_TRUE(shows(program, 9)) << "it began here";
  program.press("q");
  EXPECT_EQ(program.exit_status(), 0) << program.messages();
  EXPECT_EQ(program.messages(), "");
}

TEST_F(WindowTest, OpensAndClosesTenTimes) {
  for (int cycle = 0; cycle < 10; ++cycle) {
    WindowedProgram program(*screen_, folder_.path(), arguments("--play"));
    ASSERT_TRUE(program.has_window()) << program.messages();
    program.press("q");
    ASSERT_EQ(program.exit_status(), 0) << program.messages();
    ASSERT_EQ(program.messages(), "");
  }
}

TEST_F(WindowTest, WorksThroughAScript) {
  files::write_text(folder_ / "script", R"(settle
expect-frame 0
seek 1.2s
settle
expect-frame 12
colour residual
view top
screenshot here.png
set map.radius_m=50
restart here
settle
expect-frame 12
end
settle
expect-frame 39
)");
  WindowedProgram program(*screen_, folder_.path(), arguments("--headless --script script"));
  EXPECT_EQ(program.exit_status(), 0) << program.messages();
  EXPECT_GT(fs::file_size(folder_ / "here.png"), 10'000U);

  files::write_text(folder_ / "wrong", "settle\nexpect-frame 7\n");
  WindowedProgram failing(*screen_, folder_.path(), arguments("--headless --script wrong"));
  EXPECT_EQ(failing.exit_status(), 1);
  EXPECT_THAT(failing.messages(), HasSubstr("line 2: expect-frame 7: frame 0 is on show"));
}

TEST_F(WindowTest, SaysWhatIsWrongInAWindowToo) {
  files::write_text(folder_ / "empty.rawlog", "");
  WindowedProgram program(*screen_, folder_.path(), "empty.rawlog");
  ASSERT_TRUE(program.has_window()) << program.messages();
  EXPECT_THAT(program.messages(), HasSubstr("empty.rawlog"));
  EXPECT_THAT(program.messages(), HasSubstr("an empty file"));
  program.press("q");
  EXPECT_EQ(program.exit_status(), 1);
}

TEST_F(WindowTest, OpensARecordingThatIsCutOff) {
  std::string bytes = files::read_text(*shared_ / "street.rawlog");
  bytes.resize(bytes.size() * 6 / 10);
  files::write_text(folder_ / "cut.rawlog", bytes);
  for (const char* beside : {"street.traverse.yaml", "street.reference.tum"}) {
    fs::copy_file(*shared_ / beside, folder_ / beside);
  }
  fs::rename(folder_ / "street.traverse.yaml", folder_ / "cut.traverse.yaml");
  files::write_text(folder_ / "script", "end\nsettle\nscreenshot end.png\n");
  WindowedProgram program(*screen_, folder_.path(),
                          "cut.rawlog --headless --script script --no-index-cache");
  EXPECT_EQ(program.exit_status(), 0) << program.messages();
  EXPECT_TRUE(fs::exists(folder_ / "end.png"));
}

TEST_F(WindowTest, ShowsARunButNotOneThatWasChanged) {
  const pipeline::RunFolder run{folder_ / "run"};
  const auto recording =
      replay::Recording::open(*shared_ / "street.rawlog", testing::open_options());
  const auto source = recording.source();
  pipeline::Pipeline pipeline = recording.make_pipeline({}, 1);
  pipeline::RunOptions options;
  options.last = 5;
  ASSERT_EQ(pipeline::run(*source, pipeline, run, options, {}).status, pipeline::RunStatus::kOk);
  files::write_text(folder_ / "script", "end\nsettle\nexpect-frame 5\n");
  WindowedProgram program(*screen_, folder_.path(),
                          "run --headless --script script --no-index-cache");
  EXPECT_EQ(program.exit_status(), 0) << program.messages();

  for (const fs::path& file : {run.trajectory(), run.frames(), run.reference(), run.record()}) {
    const std::string bytes = files::read_text(file);
    std::string changed = bytes;
    const std::size_t digit = changed.find_last_of("0123456789");
    changed[digit] = changed[digit] == '1' ? '2' : '1';
    files::write_text(file, changed);
    WindowedProgram refusing(*screen_, folder_.path(),
                             "run --headless --script script --no-index-cache");
    EXPECT_EQ(refusing.exit_status(), 1) << file;
    EXPECT_THAT(refusing.messages(), HasSubstr("run/" + file.filename().string()));
    EXPECT_THAT(refusing.messages(), HasSubstr("edited"));
    files::write_text(file, bytes);
  }
}

TEST_F(WindowTest, ShowsARunOfPosesThatAnotherProgramMade) {
  const auto recording =
      replay::Recording::open(*shared_ / "street.rawlog", testing::open_options());
  const auto source = recording.source();
  pipeline::RunOptions options;
  options.last = 5;
  pipeline::Pipeline own = recording.make_pipeline({}, 1);
  const pipeline::RunFolder first{folder_ / "own"};
  ASSERT_EQ(pipeline::run(*source, own, first, options, {}).status, pipeline::RunStatus::kOk);
  source->rewind();
  const pipeline::Preset preset = pipeline::imported_preset(
      "OTHER", {"poses.file=" + first.trajectory().string(), "poses.frame=body"});
  pipeline::Pipeline imported = pipeline::make_pipeline(preset, source->info(), 1);
  const pipeline::RunFolder run{folder_ / "run"};
  ASSERT_EQ(pipeline::run(*source, imported, run, options, {}).status, pipeline::RunStatus::kOk);
  files::write_text(folder_ / "script", "end\nsettle\nexpect-frame 5\n");
  WindowedProgram program(*screen_, folder_.path(),
                          "run --headless --script script --no-index-cache");
  EXPECT_EQ(program.exit_status(), 0) << program.messages();
}

TEST_F(WindowTest, AForeignFileGetsAMessage) {
  files::write_text(folder_ / "foreign.rawlog", "this is no rawlog");
  WindowedProgram program(*screen_, folder_.path(), "foreign.rawlog");
  ASSERT_TRUE(program.has_window()) << program.messages();
  EXPECT_THAT(program.messages(), HasSubstr("foreign.rawlog"));
  program.press("Escape");
  EXPECT_EQ(program.exit_status(), 1);
}

TEST_F(WindowTest, OpensEveryRawlogOfMrptCommon) {
  const fs::path datasets = "/usr/share/mrpt/datasets";
  if (!fs::exists(datasets)) GTEST_SKIP() << "mrpt-common is not installed";
  files::write_text(folder_ / "script",
                    "settle\nseek 7\nsettle\nstep -1\nsettle\nscreenshot seen.png\n");
  std::size_t opened = 0;
  for (const auto& entry : fs::recursive_directory_iterator(datasets)) {
    if (entry.path().extension() != ".rawlog") continue;
    SCOPED_TRACE(entry.path());
    fs::remove(folder_ / "seen.png");
    WindowedProgram program(
        *screen_, folder_.path(),
        fmt::format("'{}' --headless --script script --no-index-cache", entry.path().string()));
    if (program.exit_status() == 0) {
      EXPECT_TRUE(fs::exists(folder_ / "seen.png"));
      ++opened;
    } else {  // landmarks or depth images alone: nothing that Traverse reads
      EXPECT_THAT(program.messages(), HasSubstr("expected observations of a laser"));
    }
  }
  EXPECT_GE(opened, 11U);
}

}  // namespace
}  // namespace traverse
