#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/recording_writer.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/json_document.hpp"
#include "traverse/files/text_file.hpp"

#include "dataset/made_recordings.hpp"
#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

/// Recordings of which no path can be made, or only a wrong one: whatever is wrong with them, the
/// run does not say that it is ok.
namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

using Scan = sensors::LidarScan;

/// A number from 0 to 1 that depends on the two alone.
double noise(std::size_t scan, std::size_t point) {
  auto x = static_cast<std::uint64_t>(scan * 1000003 + point + 1) * 0x9E3779B97F4A7C15U;
  x ^= x >> 29U;
  x *= 0xBF58476D1CE4E5B9U;
  x ^= x >> 32U;
  return static_cast<double>(x >> 11U) / static_cast<double>(1ULL << 53U);
}

/// Moves each point along its ray to where `range_m` says.
void set_ranges(Scan& scan,
                const std::function<double(double, double, double, std::size_t)>& range_m) {
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double norm = std::hypot(scan.x[i], scan.y[i], scan.z[i]);
    if (!(norm > 0)) continue;
    const double dx = scan.x[i] / norm;
    const double dy = scan.y[i] / norm;
    const double dz = scan.z[i] / norm;
    const double range = range_m(dx, dy, dz, i);
    scan.x[i] = static_cast<float>(range * dx);
    scan.y[i] = static_cast<float>(range * dy);
    scan.z[i] = static_cast<float>(range * dz);
  }
}

template <typename Value>
void keep(std::vector<Value>& values, const std::vector<std::size_t>& indices) {
  if (values.empty()) return;
  std::vector<Value> kept;
  for (const std::size_t i : indices) kept.push_back(values[i]);
  values = std::move(kept);
}

void keep_every(std::size_t nth, Scan& scan) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < scan.size(); i += nth) indices.push_back(i);
  keep(scan.x, indices);
  keep(scan.y, indices);
  keep(scan.z, indices);
  keep(scan.intensity, indices);
  keep(scan.ring, indices);
  keep(scan.time, indices);
}

/// What a lidar sees in a round tunnel without end: nothing that tells how far it has come.
void put_into_tunnel(Scan& scan, std::size_t number) {
  set_ranges(scan, [&](double, double dy, double dz, std::size_t i) {
    const double range = 4 / std::max(0.05, std::hypot(dy, dz));
    return range > 80 ? 0 : range + 0.02 * (noise(number, i) - 0.5);
  });
}

struct Fault {
  std::string name;
  std::function<void(Scan& scan, std::size_t number)> apply;
};

const std::vector<Fault>& faults() {
  static const std::vector<Fault> kFaults{
      {"one point of 200", [](Scan& scan, std::size_t) { keep_every(200, scan); }},
      {"returns that are all at the origin",
       [](Scan& scan, std::size_t) {
         set_ranges(scan,
                    [](double, double, double, std::size_t i) { return i % 300 == 0 ? 9 : 0; });
       }},
      {"ranges of nothing but noise",
       [](Scan& scan, std::size_t number) {
         set_ranges(scan, [&](double, double, double, std::size_t i) {
           return 2 + 50 * noise(number, i);
         });
       }},
      {"the sensor's own hull and no more",
       [](Scan& scan, std::size_t number) {
         set_ranges(scan, [&](double, double, double, std::size_t i) {
           return 0.8 + 0.01 * noise(number, i);
         });
       }},
      {"a tunnel", put_into_tunnel},
      {"every second scan mirrored", [](Scan& scan, std::size_t number) {
         if (number % 2 == 1) {
           for (float& y : scan.y) y = -y;
           for (float& x : scan.x) x = -x;
         }
       }}};
  return kFaults;
}

/// Writes the recording again, each scan as the fault has it. \returns the number of scans
void rewrite(const fs::path& from, const fs::path& to, const Fault& fault, bool with_reference) {
  const auto source = testing::open(from);
  const std::vector<sensors::Measurement> all = testing::read_all(*source);
  std::optional<dataset::Reference> reference;
  if (with_reference) reference = source->reference();
  const auto writer = dataset::write_rawlog(to, source->info(), reference, {});
  std::size_t number = 0;
  for (const sensors::Measurement& measurement : all) {
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&measurement);
    if (scan == nullptr) continue;
    auto changed = std::make_shared<Scan>(**scan);
    fault.apply(*changed, number++);
    writer->add(sensors::Measurement(std::shared_ptr<const Scan>(changed)));
  }
  writer->commit();
}

/// Three seconds of driving through a town, as it was recorded.
class LostRuns : public ::testing::Test {
 protected:
  void SetUp() override {
    const ProgramResult made =
        run_program("simulate town_short --first 40 --last 74 --sensor vlp16 -o '" +
                    (folder_ / "town.rawlog").string() + "'");
    ASSERT_EQ(made.status, 0) << made.messages;
  }

  ProgramResult run(const fs::path& recording, const std::string& options) const {
    fs::remove_all(folder_ / "run");
    return run_program("run '" + recording.string() + "' --no-report --no-hash " + options +
                       " -o '" + (folder_ / "run").string() + "'");
  }
  fs::path town() const { return folder_ / "town.rawlog"; }
  /// "none" where the run wrote no record with poses.
  std::string status() const {
    const fs::path record = folder_ / "run" / "run.json";
    if (!fs::exists(record) || !fs::exists(folder_ / "run" / "trajectory.tum")) return "none";
    return files::JsonDocument::read(record).root()["status"].text();
  }

  const TemporaryFolder folder_;
};

TEST_F(LostRuns, TheTownItselfIsOkByEveryOdometry) {
  for (const std::string preset : {"traverse", "floam", "aloam", "loam"}) {
    const ProgramResult result = run(town(), "--pipeline " + preset);
    EXPECT_EQ(result.status, 0) << preset << '\n' << result.everything();
    EXPECT_EQ(status(), "ok") << preset << '\n' << result.everything();
  }
}

TEST_F(LostRuns, ByLidarAndImuTheTownIsOkTooAndHasItsPage) {
  const fs::path folder = folder_ / "run";
  const ProgramResult result =
      run_program("run '" + town().string() + "' --no-hash --pipeline traverse-inertial -o '" +
                  folder.string() + "'");
  EXPECT_EQ(result.status, 0) << result.everything();
  EXPECT_EQ(status(), "ok") << result.everything();
  EXPECT_TRUE(fs::exists(folder / "report.html"));
}

TEST_F(LostRuns, AreNotOkByAnyOdometryWithOrWithoutAReference) {
  for (const Fault& fault : faults()) {
    for (const bool with_reference : {true, false}) {
      const fs::path broken = folder_ / "broken.rawlog";
      rewrite(town(), broken, fault, with_reference);
      for (const std::string preset : {"traverse", "floam", "aloam", "loam"}) {
        const std::string what =
            fault.name + (with_reference ? ", with its reference, by " : ", by ") + preset;
        const ProgramResult result = run(broken, "--pipeline " + preset);
        EXPECT_NE(status(), "ok") << what << '\n' << result.everything();
        if (status() == "lost") {
          EXPECT_EQ(result.status, 1) << what;
        }
        if (status() == "degraded") {
          EXPECT_EQ(result.status, 0) << what;
        }
        if (status() == "none") {
          EXPECT_NE(result.status, 0) << what;
        }
        // No score, of which a run that does not move has the best.
        if (status() == "lost") {
          EXPECT_THAT(result.output, Not(HasSubstr("MME"))) << what;
        }
      }
    }
  }
}

/// The map of a run that does not move is the sharpest, which ranked such runs first.
TEST_F(LostRuns, AreNoRankInABatch) {
  files::write_text(
      folder_ / "plan.yaml",
      "recordings: [town.rawlog]\nreports: false\nmetrics: [mme, registered_share]\n"
      "pipelines:\n  - {preset: traverse, name: still, "
      "set: {alignment.min_matches: 1000000}}\n  - {preset: traverse, name: moving}\n");
  const ProgramResult batch = run_program("batch '" + (folder_ / "plan.yaml").string() + "' -o '" +
                                          (folder_ / "out").string() + "'");
  EXPECT_EQ(batch.status, 1) << batch.everything();
  EXPECT_THAT(batch.output, HasSubstr("1 of 2 runs are ok"));
  EXPECT_THAT(batch.messages, HasSubstr("1 lost"));
  const auto document = files::JsonDocument::read(folder_ / "out" / "results.json");
  const files::JsonValue runs = document.root()["runs"];
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0]["outcome"].text(), "lost");
  EXPECT_THAT(runs[0]["reason"].text(), HasSubstr("0 of 34 frames were registered"));
  EXPECT_FALSE(runs[0]["metrics"].has("mme"));
  EXPECT_EQ(runs[0]["metrics"]["registered_share"].number(), 0);
  EXPECT_EQ(runs[1]["outcome"].text(), "ok");
  EXPECT_TRUE(runs[1]["metrics"].has("mme"));
  const std::string page = files::read_text(folder_ / "out" / "batch.html");
  EXPECT_THAT(page, HasSubstr("1 of 2 runs ok"));
  EXPECT_LT(page.find("\"name\":\"moving\""), page.find("\"name\":\"still\""));
}

TEST_F(LostRuns, SayWhyOnTheConsoleAndWriteEverything) {
  const fs::path broken = folder_ / "broken.rawlog";
  rewrite(town(), broken, faults().front(), false);
  const ProgramResult result = run(broken, "");
  ASSERT_EQ(status(), "lost") << result.everything();
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.output, HasSubstr("status     lost"));
  EXPECT_THAT(result.output, HasSubstr("of 34 frames were registered"));
  EXPECT_THAT(result.messages, HasSubstr("the run is lost"));
  for (const char* file : {"trajectory.tum", "frames.csv", "evaluation.json", "run.json"}) {
    EXPECT_TRUE(fs::exists(folder_ / "run" / file)) << file;
  }
}

}  // namespace
}  // namespace traverse
