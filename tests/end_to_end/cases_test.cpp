#include "end_to_end/cases.hpp"

#include <cctype>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/evaluation/json.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/program.hpp"
#include "end_to_end/program_process.hpp"
#include "temporary_folder.hpp"

/// Small inputs that went wrong for users (a README in each says what is right), run by the whole
/// program. A row a case: what is right, not what it happens to do.
namespace traverse {
namespace {

namespace fs = std::filesystem;
using testing::ProgramResult;
using testing::TemporaryFolder;

/// How a command may end. A case may leave several open: whether a recording of which nothing can
/// be made is refused or lost is not for it to say.
enum Outcome : unsigned {
  kOk = 1,        ///< exit status 0; of a run, with the status ok
  kDegraded = 2,  ///< a run: exit status 0 and the status degraded
  kLost = 4,      ///< a run: exit status 1, everything written, the status lost
  kRefused = 8,   ///< exit status 1 or 2 and a message; of a run, no run folder with poses
  kNotOk = kDegraded | kLost | kRefused,
};

struct Case {
  std::string folder;
  /// In the case's folder; OUT is a folder that is not there yet. A run gets `-o OUT --no-report
  /// --no-hash` as well.
  std::string arguments;
  unsigned outcome = kOk;  ///< one of them
  /// Of the run's evaluation; 0: not asked for. Where a run may be lost as well, only one that is
  /// ok has to keep it: it is right, or it says that it is not.
  double max_ape_m = 0;
  std::vector<std::string> says = {};  ///< in what it prints, stdout or stderr
};

void PrintTo(const Case& row, std::ostream* out) { *out << row.folder << ": " << row.arguments; }

const std::string kWindow = "--pipeline gins-window";
constexpr const char* kNavigation = "run log.txt --pipeline gins-window --reference truth.tum";

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

const std::vector<Case>& rows() {
  static const std::vector<Case> kRows{
      // Right from the beginning, and to stay so.
      {"ok_fov70_noring", "run . --reference truth.tum", kOk, 0.015},
      {"ok_kitti_times_blank_lines", "run .", kOk | kDegraded, 0, {"stamp"}},
      {"ok_nav_D03b_gnss_000_middle", kNavigation, kOk, 0.03},
      {"ok_nav_D04_enc_int16", kNavigation, kOk, 0.03},
      {"ok_nav_D06_south", kNavigation, kOk, 0.03},
      {"ok_nav_D09b_alt_zero_some", kNavigation, kOk | kDegraded, 0.03},
      {"ok_nav_D12_grouped", kNavigation, kOk, 0.03},
      {"ok_nav_D19_gnss_outlier_100m", kNavigation, kOk, 0.03},
      {"ok_own_body_1.1m", "run . --reference truth.tum", kOk, 0.04},
      {"ok_pcd_dos_header_binary", "run . --reference truth.tum", kOk, 0.015},
      {"ok_pcd_no_count", "run . --reference truth.tum", kOk, 0.015},
      {"ok_ply_big_endian", "run . --reference truth.tum", kOk, 0.015},
      {"ok_ring_float", "run . --reference truth.tum", kOk, 0.015},
      {"ok_ring_one_based", "run . --reference truth.tum", kOk, 0.015},
      {"ok_time_decreasing", "run . --reference truth.tum", kOk, 0.015},
      {"ok_town_vlp16", "run . --reference truth.tum", kOk, 0.01},
      {"ok_viewpoint_ignored", "run . --reference truth.tum", kOk, 0.015},
      {"ok_width_zero_points_right", "run . --reference truth.tum", kOk, 0.015},
      // Mended, or to be mended: right, or not ok.
      {"clock_set_back_100s", "run . --reference truth.tum", kOk, 0.03, {"new segment"}},
      {"future_stamp_one_imu_line", kNavigation, kOk | kDegraded, 0.03, {"skipped"}},
      {"future_stamp_times_txt", "run . --reference truth.tum", kOk, 0.03, {"skipped"}},
      {"gnss_heading_from_east", kNavigation, kNotOk},
      {"gnss_lat_lon_swapped", kNavigation, kNotOk},
      {"gyro_deg_not_stated", kNavigation, kNotOk},
      {"hall_hdl_beams_locks_to_zero", "run . --reference truth.tum", kOk, 0.05},
      {"imu_in_g", kNavigation, kNotOk},
      {"imu_without_gravity", kNavigation, kNotOk},
      {"locks_offgrid", "run . --reference truth.tum", kOk | kDegraded, 0.05},
      {"names_cloud_sec_nsec", "run . --reference truth.tum", kOk, 0.015},
      {"scan_end_stamps_relative", "run . --reference truth.tum", kOk, 0.05},
      {"stamp_jitter_20ms", "run . --reference truth.tum", kOk, 0.1},
      {"straight_reference_no_evaluation",
       "run . --reference truth.tum",
       kOk,
       0.05,
       {"rotation about the line of the alignment not determined", "closing error"}},
      {"time_field_offset_time", "run . --reference truth.tum", kOk, 0.015},
      {"time_field_scalar_timestamp", "run . --reference truth.tum", kOk, 0.015},
      {"time_fields_sec_nsec", "run . --reference truth.tum", kOk, 0.015},
      {"time_ms_double", "run . --reference truth.tum", kOk, 0.015},
      {"time_ms_float", "run . --reference truth.tum", kOk, 0.015},
      {"time_ms_uint16", "run . --reference truth.tum", kOk, 0.015},
      {"time_us_uint32", "run . --reference truth.tum", kOk, 0.015},
      {"time_one_scan_all_equal", "run . --reference truth.tum", kOk | kDegraded, 0.03},
      {"vertical_lidar_moving_start", "run . --reference truth.tum", kOk | kNotOk, 0.05},
      {"zero_registered_bin5_columns", "run .", kOk | kDegraded, 0.05},
      {"zero_registered_bin_float64", "run .", kOk | kDegraded, 0.05},
      {"zero_registered_nan_every_7th", "run . --reference truth.tum", kOk, 0.03},
      {"zero_registered_random_tenth", "run . --reference truth.tum", kOk, 0.05},
      {"zero_registered_sparse_8x120", "run .", kLost | kRefused},
      {"zero_registered_zero_returns", "run . --reference truth.tum", kOk, 0.03},
      {"gins",
       "run cumulative_pulses_not_told.txt --recording-config vehicle.yaml " + kWindow,
       kNotOk,
       0,
       {"cumulative"}},
      {"gins",
       "run first_fixes_at_0_0.txt --recording-config vehicle.yaml " + kWindow,
       kOk | kDegraded,
       0,
       {"skipped"}},
      {"velodyne_packets", "run vlp.rawlog", kOk},
      // Text.
      {"csv_hash_header", "run . --pipeline gins-gnss --reference truth.tum", kOk, 0.03},
      {"csv_ns_unit_forgotten",
       "run . --pipeline gins-gnss",
       kRefused,
       0,
       {"csv.time_unit_s=1e-09"}},
      {"csv_ns_xyzw",
       "evaluate C02d_csv_ns_xyzw.csv --reference ref.tum",
       kOk,
       0,
       {"look like x y z w"}},
      {"euroc_float_ns", "evaluate C26c_euroc_sci.csv --reference ref.tum", kOk, 0, {"0.033755"}},
      {"euroc_float_ns", "evaluate C26d_euroc_float.csv --reference ref.tum", kOk, 0, {"0.033755"}},
      {"line_scale",
       "evaluate C12_line_exact.txt --reference C12_line_ref.txt --align scale",
       kOk,
       0,
       {"scale correction, scale 1"}},
      {"tum_utf16", "evaluate C10b_utf16.txt --reference ref.tum", kRefused, 0, {"UTF-16 text"}},
      // A reference that cannot be used is told, or used.
      {"kitti_calib_without_Tr", "run .", kOk | kDegraded, 0, {"reference"}},
      {"kitti_poses_13_columns", "run .", kOk | kDegraded, 0.03, {"APE"}},
  };
  return kRows;
}

std::string placed(std::string arguments, const fs::path& out) {
  if (arguments.starts_with("run ") || arguments.starts_with("localize ")) {
    arguments += " -o OUT --no-report --no-hash";
  }
  for (std::size_t at = 0; (at = arguments.find("OUT", at)) != std::string::npos;) {
    arguments.replace(at, 3, quoted(out));
    at += quoted(out).size();
  }
  return arguments;
}

/// What the command came to. \param out where a run stands
unsigned outcome_of(const ProgramResult& result, const fs::path& out) {
  const fs::path record = out / "run.json";
  if (!fs::exists(record) || !fs::exists(out / "trajectory.tum")) {
    return result.status == 0 ? kOk : kRefused;
  }
  const std::string status = files::JsonDocument::read(record).root()["status"].text();
  if (status == "ok" && result.status == 0) return kOk;
  if (status == "degraded" && result.status == 0) return kDegraded;
  if (status == "lost" && result.status == 1) return kLost;
  return 0;
}

double ape_of(const fs::path& run) {
  const auto evaluation = evaluation::read_evaluation(run / "evaluation.json");
  if (!evaluation.comparison) return -1;
  for (const auto& ape : evaluation.comparison->ape) {
    if (ape.relation == evaluation::Relation::kTranslation) return ape.statistics.rmse;
  }
  return -1;
}

class Cases : public ::testing::TestWithParam<Case> {};

TEST_P(Cases, ComeToWhatIsRight) {
  if (testing::cases().empty()) GTEST_SKIP() << testing::kNoCases;
  const Case& row = GetParam();
  const fs::path folder = testing::cases() / row.folder;
  ASSERT_TRUE(fs::is_directory(folder)) << "no case " << row.folder;
  const TemporaryFolder temporary;
  const fs::path out = temporary / "out";
  std::string arguments = placed(row.arguments, out);
#ifdef TRAVERSE_SANITIZED
  if (arguments.starts_with("run ")) arguments += " --last 4";  // its figures are the other build's
#endif
  const ProgramResult result =
      testing::run_program(arguments, "cd " + quoted(folder) + " && " + TRAVERSE_PROGRAM);
  const unsigned outcome = outcome_of(result, out);
#ifdef TRAVERSE_SANITIZED
  EXPECT_NE(outcome, 0U) << result.everything();
  EXPECT_THAT(result.everything(), ::testing::Not(::testing::HasSubstr("Sanitizer")));
  return;
#endif
  EXPECT_NE(outcome & row.outcome, 0U)
      << "outcome " << outcome << " of " << row.outcome << ", exit status " << result.status << '\n'
      << result.everything();
  for (const std::string& words : row.says) {
    EXPECT_THAT(result.everything(), ::testing::HasSubstr(words));
  }
  const bool may_be_wrong = (row.outcome & kLost) != 0 && outcome != kOk;
  if (row.max_ape_m == 0 || may_be_wrong) return;
  const double ape_m = ape_of(out);
  EXPECT_GE(ape_m, 0) << "no comparison with the reference";
  EXPECT_LE(ape_m, row.max_ape_m);
}

std::string test_name(const ::testing::TestParamInfo<Case>& row) {
  std::string name;
  for (const char c : row.param.folder)
    name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name + "_" + std::to_string(row.index);
}

INSTANTIATE_TEST_SUITE_P(OfUsers, Cases, ::testing::ValuesIn(rows()), test_name);

/// The valid returns of the packets were counted from their bytes.
TEST(PacketCase, EveryReturnIsConverted) {
#ifdef TRAVERSE_SANITIZED
  GTEST_SKIP() << "the decoder's own tests run in this build";
#endif
  if (testing::cases().empty()) GTEST_SKIP() << testing::kNoCases;
  const TemporaryFolder temporary;
  const ProgramResult result =
      testing::run_program("convert " + quoted(testing::cases() / "velodyne_packets/vlp.rawlog") +
                           " " + quoted(temporary / "scans"));
  ASSERT_EQ(result.status, 0) << result.output << result.messages;
  std::size_t points = 0;
  for (const auto& entry : fs::directory_iterator(temporary / "scans")) {
    if (entry.path().extension() != ".pcd") continue;
    const std::string text = files::read_text(entry.path());
    points += std::stoul(text.substr(text.find("\nPOINTS ") + 8, 9));
  }
  EXPECT_EQ(points, 1060073U);
}

/// sbatch answers "Socket timed out" once, squeue always does, and nothing ever runs: so the
/// command is stopped once it has asked again.
TEST(SlurmCase, ASubmissionThatTimesOutIsTriedAgain) {
  if (testing::cases().empty()) GTEST_SKIP() << testing::kNoCases;
  const fs::path folder = testing::cases() / "slurm_sbatch_times_out_once";
  const fs::path calls = folder / "bin" / "calls";
  fs::remove(calls);
  const TemporaryFolder temporary;
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", ((folder / "bin").string() + ":" + path).c_str(), 1);
  testing::ProgramProcess batch({"batch", (folder / "plan.yaml").string(), "-o",
                                 (temporary / "out").string(), "--executor", "slurm"},
                                temporary / "log");
  ::setenv("PATH", path.c_str(), 1);
  const auto times_submitted = [&] {
    std::error_code none;
    const auto bytes = fs::file_size(calls, none);
    return none ? 0 : bytes / std::string("call\n").size();
  };
  for (int tenths = 0; times_submitted() < 2 && tenths < 1200 && !batch.has_ended(); ++tenths) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  batch.signal(SIGINT);
  EXPECT_EQ(batch.wait(), 130) << files::read_text(temporary / "log");
  EXPECT_EQ(times_submitted(), 2U);
}

}  // namespace
}  // namespace traverse
