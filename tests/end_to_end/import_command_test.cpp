#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "dataset/made_recordings.hpp"
#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;

/// A folder of small scans, and poses of them as somebody's program would write them.
class ImportCommand : public ::testing::Test {
 protected:
  ImportCommand() {
    testing::make_kitti_folder(folder_ / "drive", kScans);
    std::string kitti;
    std::string tum;
    for (std::size_t i = 0; i < kScans; ++i) {
      const double x = 0.5 * static_cast<double>(i);
      kitti += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0\n", x);
      tum += fmt::format("{} {} 0 0 0 0 0 1\n", 0.1 * static_cast<double>(i), x);
    }
    files::write_text(folder_ / "kitti.txt", kitti);
    files::write_text(folder_ / "poses.tum", tum);
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  ProgramResult import(const std::string& trajectory, const std::string& options) const {
    return run_program("import " + at(trajectory) + " --recording " + at("drive") + " -o " +
                       at("run") + " --no-hash " + options);
  }

  static constexpr std::size_t kScans = 12;
  testing::TemporaryFolder folder_;
};

TEST_F(ImportCommand, MakesARunThatTheOtherCommandsTake) {
  const ProgramResult made =
      import("kitti.txt", "--name OTHER --no-report --reference " + at("poses.tum"));
  ASSERT_EQ(made.status, 0) << made.everything();
  EXPECT_THAT(made.output, HasSubstr("12: 12 at a pose"));
  EXPECT_THAT(made.output, Not(HasSubstr("ms per frame")));
  const ProgramResult report = run_program("report --no-pictures " + at("run"));
  ASSERT_EQ(report.status, 0) << report.everything();
  const std::string page = files::read_text(folder_ / "run/report.html");
  EXPECT_THAT(page, HasSubstr("OTHER"));
  EXPECT_THAT(page, Not(HasSubstr("id=\"timing\"")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"health\"")));
  const auto figures = json::parse(files::read_text(folder_ / "run/report.json"))["figures"];
  EXPECT_TRUE(figures.contains("ape_rmse_m"));
  for (const char* absent : {"frame_median_ms", "peak_memory_mb", "lost_frames", "restarts"}) {
    EXPECT_FALSE(figures.contains(absent)) << absent;
  }
  const ProgramResult info = run_program("info " + at("run"));
  EXPECT_EQ(info.status, 0) << info.everything();
  EXPECT_THAT(info.output, HasSubstr("not known: another program made the poses"));
  std::filesystem::rename(folder_ / "run", folder_ / "other");
  ASSERT_EQ(import("poses.tum", "--no-report --reference " + at("poses.tum")).status, 0);
  const ProgramResult compared =
      run_program("compare " + at("other") + " " + at("run") + " -o " + at("page.html"));
  EXPECT_EQ(compared.status, 0) << compared.everything();
  EXPECT_EQ(run_program("evaluate " + at("run") + " --rpe 1f").status, 0);
}

TEST_F(ImportCommand, RunsOfSeveralRecordingsAreOnePage) {
  testing::make_kitti_folder(folder_ / "second", kScans + 18);
  std::string far;   // the same drive, half as long again
  std::string near;  // and of one that is off by a centimetre now and then
  for (std::size_t i = 0; i < kScans + 18; ++i) {
    const double x = 0.5 * static_cast<double>(i);
    far += fmt::format("1 0 0 {} 0 1 0 {} 0 0 1 0\n", x, 0.3 * std::sin(0.9 * x));
    near += fmt::format("1 0 0 {} 0 1 0 {} 0 0 1 0\n", x, 0.01 * std::sin(0.9 * x));
  }
  files::write_text(folder_ / "far.txt", far);
  files::write_text(folder_ / "near.txt", near);
  std::string truth;
  for (std::size_t i = 0; i < kScans + 18; ++i) {
    truth += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0\n", 0.5 * static_cast<double>(i));
  }
  files::write_text(folder_ / "truth.txt", truth);
  const auto run = [&](const std::string& poses, const std::string& drive, const std::string& name,
                       const std::string& out) {
    const ProgramResult made =
        run_program("import " + at(poses) + " --recording " + at(drive) + " -o '" + at(out) +
                    "' --no-report --name " + name + " --reference " +
                    at(drive == "drive" ? "kitti.txt" : "truth.txt"));
    ASSERT_EQ(made.status, 0) << made.everything();
  };
  std::filesystem::create_directory(folder_ / "runs of all");
  run("kitti.txt", "drive", "NEAR", "runs of all/a");
  run("near.txt", "second", "NEAR", "runs of all/b");
  run("far.txt", "second", "FAR", "runs of all/c");
  const std::string runs = "compare '" + at("runs of all/a") + "' '" + at("runs of all/b") + "' '" +
                           at("runs of all/c") + "' -o ";
  const ProgramResult compared = run_program(runs + at("all.html"));
  ASSERT_EQ(compared.status, 0) << compared.everything();
  EXPECT_THAT(compared.output, HasSubstr("NEAR"));
  const std::string page = files::read_text(folder_ / "all.html");
  EXPECT_THAT(page, HasSubstr("more than the first"));
  EXPECT_THAT(page, HasSubstr("poses of another program"));
  EXPECT_THAT(page, HasSubstr("SE(3) alignment"));
  EXPECT_THAT(page, Not(HasSubstr("id=\"sweep-chart\"")));
  const json numbers = json::parse(files::read_text(folder_ / "all.json"));
  EXPECT_EQ(numbers["recordings"].size(), 2U);
  ASSERT_EQ(numbers["runs"].size(), 3U);
  EXPECT_EQ(numbers["runs"][1]["folder"], "runs%20of%20all/b");
  EXPECT_EQ(numbers["variants"][0]["name"], "NEAR");
  EXPECT_THAT(files::read_text(folder_ / "all.tex"), HasSubstr("tabular"));
  EXPECT_EQ(run_program(runs + at("all.html")).status, 0) << "its own page is replaced";
  files::write_text(folder_ / "mine.json", "{}");
  EXPECT_THAT(run_program(runs + at("mine.html")).messages, HasSubstr("already"));
  EXPECT_EQ(run_program(runs + at("private.html") + " --private").status, 0);
  EXPECT_THAT(files::read_text(folder_ / "private.html"), Not(HasSubstr(folder_.path().string())));
}

TEST_F(ImportCommand, SurveyedPointsAreInTheReport) {
  // A bend, and a prism 1 m to the left and 7 m above, on a grid; each point is 1 cm off in height.
  std::string bent;
  std::string points = "name,stamp_s,e_m,n_m,h_m,sigma_m\n";
  for (std::size_t i = 0; i < kScans; ++i) {
    const double x = 0.5 * static_cast<double>(i);
    const double y = 0.05 * x * x;
    const double t = 0.1 * static_cast<double>(i);
    bent += fmt::format("{} {} {} 0 0 0 0 1\n", t, x, y);
    if (i % 2 == 0) {
      points += fmt::format("P{},{},{},{},{},0.01\n", i, t, 100 + x, 200 + y + 1,
                            i % 4 == 0 ? 7.01 : 6.99);
    }
  }
  files::write_text(folder_ / "bent.tum", bent);
  files::write_text(folder_ / "points.csv", points);
  const std::string options = "--no-report --point 0,1,7 --checkpoints " + at("points.csv");
  const ProgramResult line = import("poses.tum", options);
  EXPECT_EQ(line.status, 1) << "of a straight line no alignment is determined";
  EXPECT_THAT(line.messages, HasSubstr("at least three points that are not on one line"));
  const ProgramResult made = import("bent.tum", options + " --force");
  ASSERT_EQ(made.status, 0) << made.everything();
  ASSERT_EQ(run_program("report --no-pictures " + at("run")).status, 0);
  EXPECT_THAT(files::read_text(folder_ / "run/report.html"), HasSubstr("id=\"checkpoints\""));
  const auto residuals = json::parse(files::read_text(folder_ / "run/checkpoints.json"));
  EXPECT_EQ(residuals["check"]["count"], 6);
  EXPECT_LT(residuals["check"]["rmse_vertical_m"], 0.011);
  EXPECT_GT(residuals["check"]["rmse_vertical_m"], 0.005);
  std::filesystem::resize_file(folder_ / "run/checkpoints.json", 100);
  const ProgramResult cut = run_program("report --no-pictures " + at("run"));
  EXPECT_EQ(cut.status, 1);
  EXPECT_THAT(cut.messages, HasSubstr("checkpoints.json"));
}

TEST_F(ImportCommand, TimesThatAreToldAreShown) {
  files::write_text(folder_ / "timing.yaml",
                    "threads: 2\nframe_ms: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]\n");
  ASSERT_EQ(import("kitti.txt", "--no-report --timing " + at("timing.yaml")).status, 0);
  ASSERT_EQ(run_program("report --no-pictures " + at("run")).status, 0);
  const auto figures = json::parse(files::read_text(folder_ / "run/report.json"))["figures"];
  EXPECT_EQ(figures["frame_median_ms"]["value"], 6.5);
  EXPECT_FALSE(figures.contains("peak_memory_mb"));
}

TEST_F(ImportCommand, SaysWhatIsWrongAndWritesNothing) {
  files::write_text(folder_ / "cut.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1\n");
  const ProgramResult cut = import("cut.txt", "");
  EXPECT_EQ(cut.status, 1);
  EXPECT_THAT(cut.messages, HasSubstr("cut.txt, line 2: expected the 12 numbers"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "run"));
  const ProgramResult clock = import("poses.tum", "--time-offset auto");
  EXPECT_EQ(clock.status, 1);
  EXPECT_THAT(clock.messages, HasSubstr("needs a gyroscope or a reference"));
  EXPECT_THAT(clock.messages, HasSubstr("--time-offset SECONDS"));
  EXPECT_EQ(import("poses.tum", "--time-offset soon").status, 2);
  EXPECT_EQ(run_program("import " + at("poses.tum") + " --recording motion_compensated=true -o " +
                        at("run"))
                .status,
            2);
  const ProgramResult other = import("poses.tum", "--time-offset 5000");
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.messages, HasSubstr("expected poses at the times of the scans"));
}

TEST_F(ImportCommand, APeersFiguresAreEvos) {
  const auto peers = testing::test_data() / "peer_trajectories";
  const auto drive = testing::kitti_drive("2011_09_26_drive_0005");
  if (!std::filesystem::exists(peers)) GTEST_SKIP() << "no trajectories in " << peers;
  if (!std::filesystem::exists(drive)) GTEST_SKIP() << testing::kNoDrives;
  const ProgramResult made = run_program(fmt::format(
      "import {}/d0005_kiss.txt --recording {} --last 99 -o {} --no-report --no-hash --reference "
      "{}/poses_velo_velint.txt --reference-frame lidar",
      peers.string(), drive.string(), at("run"), drive.string()));
  ASSERT_EQ(made.status, 0) << made.everything();
  const auto found = json::parse(files::read_text(folder_ / "run/evaluation.json"));
  const auto known = json::parse(std::ifstream(peers / "evo_reference.json"));
  std::size_t compared = 0;
  const auto expect_equal = [&](const json& ours, const json& evos) {
    for (const auto& [name, value] : evos.items()) {
      const double is = value.get<double>();
      EXPECT_NEAR(ours.at(name).get<double>(), is, 1e-9 * std::max(1.0, is)) << name;
      ++compared;
    }
  };
  for (const auto& item : known.at("cases")) {
    if (item.at("estimate") != "d0005_kiss.txt") continue;
    expect_equal(found["ape"]["translation"], item["ape"]);
    expect_equal(found["ape"]["angle-deg"], item["ape_angle_deg"]);
    for (const auto& rpe : found["rpe"]) {
      if (rpe["delta"] != 10) continue;
      if (rpe["relation"] == "translation") expect_equal(rpe["stats"], item["rpe10"]);
      if (rpe["relation"] == "angle-deg") expect_equal(rpe["stats"], item["rpe10_angle_deg"]);
    }
  }
  EXPECT_EQ(compared, 28U);
}

}  // namespace
}  // namespace traverse
