#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/provenance.hpp"

#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

/// A simulated stretch of street, and a run of it that was made from relative paths in a folder
/// that is not the tests'.
class RunPlaces : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    fs::create_directory(file("home"));
    const ProgramResult simulated =
        run_program("simulate town_short --sensor vlp16 --first 40 --duration 1 -o " +
                    file("home/street.rawlog"));
    ASSERT_EQ(simulated.status, 0) << simulated.messages;
    files::write_text(file("home/stated.yaml"), "name: a street\nlidar: {max_range_m: 80}\n");
    files::write_text(file("home/own_preset.yaml"),
                      files::read_text(TRAVERSE_SHARE_DIR "/pipelines/floam.yaml"));
    const ProgramResult run = in(file("home"),
                                 "run street.rawlog -o runs/first --recording-config stated.yaml "
                                 "--pipeline own_preset.yaml --set slam.use=true --no-hash");
    ASSERT_EQ(run.status, 0) << run.everything();
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string file(const std::string& name) { return (*folder_ / name).string(); }

  /// The program in another working directory.
  static ProgramResult in(const std::string& directory, const std::string& arguments,
                          const std::string& environment = "") {
    return run_program(arguments,
                       "cd '" + directory + "' && " + environment + " " TRAVERSE_PROGRAM);
  }

  static inline TemporaryFolder* folder_ = nullptr;
};

TEST_F(RunPlaces, ARunIsUsedFromAnyFolder) {
  const std::string run = file("home/runs/first").substr(1);  // from the root
  const auto report = in("/", "report " + run + " --no-pictures");
  EXPECT_EQ(report.status, 0) << report.messages;
  const auto info = in("/", "info " + run);
  EXPECT_EQ(info.status, 0) << info.messages;
  const auto localized =
      in("/", fmt::format("localize {}.rawlog --map {} -o {} --no-hash --no-report",
                          file("home/street").substr(1), run, file("localized")));
  EXPECT_EQ(localized.status, 0) << localized.messages;
  const auto evaluated = in("/", "evaluate " + run);
  EXPECT_EQ(evaluated.status, 0) << evaluated.messages;
}

TEST_F(RunPlaces, InfoShowsTheRun) {
  const auto info = run_program("info " + file("home/runs/first") + " --json " + file("run.json"));
  ASSERT_EQ(info.status, 0) << info.messages;
  EXPECT_THAT(info.output, AllOf(HasSubstr("first: a run"), HasSubstr("status     ok"),
                                 HasSubstr("a street (MRPT rawlog), " + file("home/street.rawlog")),
                                 HasSubstr("own_preset, slam.use=true"), HasSubstr("10 estimated"),
                                 HasSubstr("APE "), HasSubstr("as the run wrote them"),
                                 HasSubstr("traverse-replay " + file("home/runs/first"))));
  EXPECT_THAT(info.output, AllOf(HasSubstr("traverse map "), HasSubstr("traverse localize "),
                                 Not(HasSubstr("scans"))));
  const json told = json::parse(files::read_text(file("run.json")));
  EXPECT_EQ(told["status"], "ok");
  EXPECT_EQ(told["frames"], 10);
  EXPECT_LT(told["figures"]["ape_rmse_m"], 0.2);
  // As a recording it is refused, whoever asks.
  for (const char* command : {"run {} -o {}", "convert {} {}.rawlog"}) {
    const auto refused =
        run_program(fmt::format(fmt::runtime(command), file("home/runs/first"), file("of_a_run")));
    EXPECT_EQ(refused.status, 1) << command;
    EXPECT_THAT(refused.messages, HasSubstr("the folder of a run")) << command;
  }
}

TEST_F(RunPlaces, InfoTellsWhatCannotBeFound) {
  fs::create_directory(file("alone"));
  fs::copy(file("home/runs/first"), file("alone/run"), fs::copy_options::recursive);
  fs::rename(file("home/street.rawlog"), file("home/away.rawlog"));
  const auto info = run_program("info " + file("alone/run"));
  fs::rename(file("home/away.rawlog"), file("home/street.rawlog"));
  ASSERT_EQ(info.status, 0) << info.messages;
  EXPECT_THAT(info.output, AllOf(HasSubstr("street.rawlog, which is not there"),
                                 HasSubstr("--moved-to RECORDING")));
  std::ofstream(file("alone/run/frames.csv"), std::ios::app) << "\n";
  const auto damaged = run_program("info " + file("alone/run"));
  EXPECT_EQ(damaged.status, 1);
  EXPECT_THAT(damaged.messages, HasSubstr("alone/run/frames.csv"));
}

/// Whether the text has the word; a short one stands in pictures and packed points by chance.
bool has_word(const std::string& bytes, const std::string& word, const fs::path& file) {
  constexpr std::size_t kByChance = 8;
  const bool is_plain = file.extension() == ".json" || file.extension() == ".csv";
  if (word.size() < kByChance && !is_plain) return false;
  const auto is_letter = [&](std::size_t i) {
    return i < bytes.size() && std::isalnum(static_cast<unsigned char>(bytes[i])) != 0;
  };
  for (std::size_t at = bytes.find(word); at != std::string::npos; at = bytes.find(word, at + 1)) {
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + word.size())) return true;
  }
  return false;
}

/// Texts that tell whose machine it is, each with where it was found.
std::vector<std::string> told_in(const fs::path& folder, const std::vector<std::string>& secrets) {
  std::vector<std::string> told;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    for (const std::string& secret : secrets) {
      if (!has_word(bytes, secret, entry.path())) continue;
      told.push_back(entry.path().filename().string() + ": " + secret);
    }
  }
  return told;
}

class PrivateRuns : public RunPlaces {
 protected:
  static std::vector<std::string> secrets() {
    const pipeline::HostInfo host = pipeline::host_info();
    std::vector<std::string> all{folder_->path().string(), host.name, host.name + ": ",
                                 fs::path(TRAVERSE_PROGRAM).parent_path().string()};
    if (host.cpu != "unknown") all.push_back(host.cpu);
    return all;
  }
  static std::string as_alice() { return "HOME='" + file("home") + "'"; }
};

TEST_F(PrivateRuns, TellNothingOfTheMachine) {
  const std::string recording = file("home/street.rawlog");
  const auto run = in(file("home"),
                      fmt::format("run {} -o {} --private --no-hash --recording-config {}",
                                  recording, file("home/private"), file("home/stated.yaml")),
                      as_alice());
  ASSERT_EQ(run.status, 0) << run.messages;
  EXPECT_THAT(told_in(file("home/private"), secrets()), IsEmpty());
  EXPECT_THAT(files::read_text(file("home/private/report.html")),
              AllOf(HasSubstr("traverse-replay private --at"), HasSubstr("not told")));
  // Such a folder keeps to it, and finds its recording all the same.
  const auto report = in("/", "report " + file("home/private").substr(1) + " --no-pictures");
  EXPECT_EQ(report.status, 0) << report.messages;
  EXPECT_THAT(told_in(file("home/private"), secrets()), IsEmpty());
  EXPECT_THAT(in("/", "info " + file("home/private").substr(1)).output, HasSubstr(recording));
}

TEST_F(PrivateRuns, TheOthersTellIt) {
  EXPECT_THAT(told_in(file("home/runs/first"), secrets()), Not(IsEmpty()));
  const json record = json::parse(files::read_text(file("home/runs/first/run.json")));
  EXPECT_EQ(record["recording"]["path"], file("home/street.rawlog"));
  EXPECT_EQ(record["recording"]["path_from_run"], "../../street.rawlog");
}

TEST_F(PrivateRuns, APageOfAnOtherRunMayKeepToItToo) {
  fs::copy(file("home/runs/first"), file("shown"), fs::copy_options::recursive);
  fs::remove_all(file("shown/images"));
  ASSERT_EQ(run_program("report " + file("shown") + " --no-pictures --private").status, 0);
  for (const char* name : {"report.html", "report.json"}) {
    fs::create_directories(file("pages"));
    fs::copy_file(file("shown/") + name, file("pages/") + name);
  }
  const auto compared = run_program(fmt::format("compare {} {} -o {} --private", file("shown"),
                                                file("home/runs/first"), file("pages/both.html")));
  ASSERT_EQ(compared.status, 0) << compared.messages;
  EXPECT_THAT(told_in(file("pages"), secrets()), IsEmpty());
  files::write_text(file("budget.yaml"), "private: true\nape_rmse_m: 100\n");
  fs::remove_all(file("pages"));
  const auto budgeted = run_program(
      fmt::format("report {} --no-pictures --budget {}", file("shown"), file("budget.yaml")));
  ASSERT_EQ(budgeted.status, 0) << budgeted.messages;
  fs::create_directories(file("pages"));
  fs::copy_file(file("shown/report.html"), file("pages/report.html"));
  EXPECT_THAT(told_in(file("pages"), secrets()), IsEmpty());
}

TEST_F(PrivateRuns, ABudgetMayAskForIt) {
  files::write_text(file("budget.yaml"), "private: true\nape_rmse_m: 100\n");
  const auto run = run_program(fmt::format("run {} -o {} --no-report --no-hash --budget {}",
                                           file("home/street.rawlog"), file("home/budgeted"),
                                           file("budget.yaml")));
  ASSERT_EQ(run.status, 0) << run.messages;
  EXPECT_THAT(told_in(file("home/budgeted"), secrets()), IsEmpty());
}

TEST_F(PrivateRuns, OfABatchTheResultsTellNothing) {
  files::write_text(file("home/plan.yaml"), fmt::format(R"(
recordings: [{{path: {0}, name: street}}, {{path: {0}, name: again, last: 7}}]
pipelines: [{{preset: floam, set: {{start.scans: 0}}}}]
private: true
)",
                                                        file("home/street.rawlog")));
  const auto made = run_program("batch " + file("home/plan.yaml") + " -o " + file("home/out"));
  ASSERT_EQ(made.status, 0) << made.everything();
  std::vector<std::string> told = told_in(file("home/out/runs"), secrets());
  EXPECT_THAT(told, IsEmpty());
  fs::create_directory(file("home/results"));
  for (const char* name : {"batch.html", "results.csv", "results.json", "leaderboard.tex"}) {
    fs::copy_file(file("home/out/") + name, file("home/results/") + name);
  }
  EXPECT_THAT(told_in(file("home/results"), secrets()), IsEmpty());
  // Its runs know their recording from where they stand now.
  for (const auto& entry : fs::directory_iterator(file("home/out/runs"))) {
    const auto info = run_program("info " + entry.path().string());
    EXPECT_THAT(info.output, HasSubstr(file("home/street.rawlog"))) << info.messages;
  }
  // The same plan without is made again: those runs tell too little.
  const auto again = run_program("batch " + file("home/plan.yaml") + " -o " + file("home/out"));
  EXPECT_THAT(again.output, HasSubstr("0 made now, 2 finished before"));
}

TEST_F(RunPlaces, ARunNamesWhatLiesBesideIt) {
  fs::create_directory(file("beside"));
  fs::copy_file(file("home/street.rawlog"), file("beside/street.rawlog"));
  fs::copy_file(file("home/street.reference.tum"), file("beside/street_gt.tum"));
  const auto info = run_program("info " + file("beside/street.rawlog"));
  EXPECT_THAT(info.output, AllOf(HasSubstr("Not used"), HasSubstr("street_gt.tum: 100 poses"),
                                 HasSubstr("--reference " + file("beside/street_gt.tum") + "\n")));
  const auto run = run_program(fmt::format("run {} -o {} --no-report --no-hash",
                                           file("beside/street.rawlog"), file("beside/run")));
  ASSERT_EQ(run.status, 0) << run.messages;
  const std::string option = "--reference " + file("beside/street_gt.tum");
  EXPECT_THAT(run.output, AllOf(HasSubstr("not used   street_gt.tum"), HasSubstr(option)));
  const auto used =
      run_program(fmt::format("run {} -o {} --no-report --no-hash {}", file("beside/street.rawlog"),
                              file("beside/run"), option));
  EXPECT_THAT(used.output, AllOf(HasSubstr("APE"), Not(HasSubstr("not used")))) << used.messages;
}

}  // namespace
}  // namespace traverse
