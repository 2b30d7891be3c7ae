#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <random>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/program.hpp"
#include "end_to_end/program_process.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using testing::ProgramProcess;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;
using Clock = std::chrono::steady_clock;

#ifdef TRAVERSE_SANITIZED
constexpr int kKills = 4;
#else
constexpr int kKills = 20;
#endif

/// Every file below a folder: its name, and the digest of its content.
using Digests = std::map<std::string, std::string>;

Digests digests_of(const fs::path& folder) {
  Digests digests;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).generic_string();
    digests[name] = entry.is_regular_file() ? files::sha256_of_file(entry.path()) : "a folder";
  }
  return digests;
}

/// Without what a killed program leaves under temporary names.
Digests without_temporaries(Digests digests) {
  static const std::regex temporary(R"((^|.*/)\..+\.traverse-[0-9]+-[0-9]+\.partial(/.*)?)");
  std::erase_if(digests, [](const auto& file) { return std::regex_match(file.first, temporary); });
  return digests;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += " '" + word + "'";
  return text;
}

/// A command that writes something over an earlier result of its own.
struct Writing {
  std::string name;
  std::vector<std::string> earlier;  ///< the words that made what is there
  std::vector<std::string> words;
};

class OutputSafety : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    const ProgramResult made = run_program(simulation("drive.rawlog", 1));
    ASSERT_EQ(made.status, 0) << made.everything();
    const ProgramResult run =
        run_program("run " + shared("drive.rawlog") + " --no-report --no-hash -o " + shared("run"));
    ASSERT_EQ(run.status, 0) << run.everything();
  }
  static void TearDownTestSuite() { delete shared_; }

  static std::string shared(const std::string& name) { return (*shared_ / name).string(); }
  static std::vector<std::string> simulation_words(const std::string& file, int seed) {
    return {"simulate", "corridor_loop",      "--first", "30", "--duration", "0.8",
            "--seed",   std::to_string(seed), "-o",      file};
  }
  static std::string simulation(const std::string& name, int seed) {
    return joined(simulation_words(shared(name), seed));
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// Files that no command may touch, some under names much like its own.
  void add_foreign_files() const {
    fs::create_directories(folder_ / "out/deep");
    for (const char* name : {"notes.txt", ".q.rawlog.4711.partial", "q.rawlog.backup",
                             "deep/map.ply", "q.png", ".scans.traverse-x-1.partial"}) {
      files::write_text(folder_ / "out" / name, std::string("foreign ") + name);
    }
  }

  std::vector<Writing> writings() const {
    const std::string drive = shared("drive.rawlog");
    return {{"simulate", simulation_words(file("out/q.rawlog"), 2),
             simulation_words(file("out/q.rawlog"), 3)},
            {"convert",
             {"convert", drive, file("out/q.rawlog"), "--last", "3"},
             {"convert", drive, file("out/q.rawlog"), "--gzip", "9"}},
            {"convert to a folder",
             {"convert", drive, file("out/earlier"), "--last", "3"},
             {"convert", drive, file("out/scans"), "--format", "ply"}},
            {"map",
             {"map", shared("run"), "-o", file("out/map"), "--set", "voxel_m=0.3"},
             {"map", shared("run"), "-o", file("out/map"), "--attributes"}}};
  }

  /// Makes the earlier result beside foreign files, and a copy of it all. Then the command is run
  /// to its end once.
  void prepare(const Writing& writing) {
    fs::remove_all(folder_ / "out");
    fs::remove_all(folder_ / "kept");
    add_foreign_files();
    const ProgramResult earlier = run_program(joined(writing.earlier));
    ASSERT_EQ(earlier.status, 0) << earlier.everything();
    fs::copy(folder_ / "out", folder_ / "kept", fs::copy_options::recursive);
    before_ = digests_of(folder_ / "out");
    const auto began = Clock::now();
    const ProgramResult done = run_program(joined(writing.words));
    ASSERT_EQ(done.status, 0) << done.everything();
    duration_ = Clock::now() - began;
    after_ = digests_of(folder_ / "out");
    ASSERT_NE(before_, after_);
    restore();
  }
  void restore() const {
    fs::remove_all(folder_ / "out");
    fs::copy(folder_ / "kept", folder_ / "out", fs::copy_options::recursive);
  }

  void wait_a_random_while() {
    std::uniform_real_distribution<double> share(0, 1.05);
    std::this_thread::sleep_for(
        std::chrono::duration_cast<Clock::duration>(share(random_) * duration_));
  }

  TemporaryFolder folder_;
  Digests before_;  ///< of the folder with the earlier result
  Digests after_;   ///< and with the new one
  Clock::duration duration_{};
  std::mt19937 random_{20261130};
  static inline TemporaryFolder* shared_ = nullptr;
};

TEST_F(OutputSafety, KilledAtAnyMomentTheEarlierResultIsWholeOrTheNewOneIs) {
  for (const Writing& writing : writings()) {
    SCOPED_TRACE(writing.name);
    ASSERT_NO_FATAL_FAILURE(prepare(writing));
    for (int kill = 0; kill < kKills; ++kill) {
      ProgramProcess process(writing.words, folder_ / "log");
      wait_a_random_while();
      process.signal(SIGKILL);
      process.wait();
      const Digests left = without_temporaries(digests_of(folder_ / "out"));
      ASSERT_TRUE(left == before_ || left == after_) << files::read_text(folder_ / "log");
      if (left == after_) restore();
    }
    // The next command removes what the killed ones left.
    const ProgramResult done = run_program(joined(writing.words));
    EXPECT_EQ(done.status, 0) << done.everything();
    EXPECT_EQ(digests_of(folder_ / "out"), after_);
  }
}

TEST_F(OutputSafety, ASignalLeavesNothingUnfinishedAndItsStatus) {
  for (const Writing& writing : writings()) {
    SCOPED_TRACE(writing.name);
    ASSERT_NO_FATAL_FAILURE(prepare(writing));
    int interrupted = 0;
    for (int round = 0; round < 3; ++round) {
      for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        ProgramProcess process(writing.words, folder_ / "log");
        process.wait_for_handlers();
        wait_a_random_while();
        process.signal(signal);
        const int status = process.wait();
        const Digests left = digests_of(folder_ / "out");
        if (status == 0) {
          EXPECT_EQ(left, after_);
          restore();
          continue;
        }
        ++interrupted;
        EXPECT_EQ(status, 128 + signal) << files::read_text(folder_ / "log");
        EXPECT_TRUE(left == before_ || left == after_);
        EXPECT_THAT(files::read_text(folder_ / "log"),
                    AllOf(HasSubstr("interrupted"), Not(HasSubstr("cannot be written"))));
        restore();
      }
    }
    EXPECT_GT(interrupted, 0);
  }
}

/// The command refuses and says which file is in its way; nothing is changed.
void expect_refusal(const std::vector<std::string>& words, const std::string& named,
                    const fs::path& folder) {
  const Digests before = digests_of(folder);
  const ProgramResult result = run_program(joined(words));
  EXPECT_EQ(result.status, 1) << joined(words) << result.everything();
  EXPECT_THAT(result.messages, HasSubstr(named));
  EXPECT_EQ(digests_of(folder), before) << joined(words);
}

TEST_F(OutputSafety, FilesThatTheProgramDidNotWriteAreNotReplaced) {
  add_foreign_files();
  const fs::path out = folder_ / "out";
  const std::string drive = shared("drive.rawlog");
  for (const char* name :
       {"a.rawlog", "b.traverse.yaml", "c.reference.tum", "d.gnss.csv", "e.world.yaml", "f.txt"}) {
    files::write_text(out / name, "# foreign\n");
  }
  expect_refusal(simulation_words(file("out/a.rawlog"), 2), "a.rawlog", out);
  expect_refusal(simulation_words(file("out/d.rawlog"), 2), "d.gnss.csv", out);
  expect_refusal(simulation_words(file("out/e.rawlog"), 2), "e.world.yaml", out);
  expect_refusal({"convert", drive, file("out/a.rawlog")}, "a.rawlog", out);
  expect_refusal({"convert", drive, file("out/b.rawlog")}, "b.traverse.yaml", out);
  expect_refusal({"convert", drive, file("out/c.rawlog")}, "c.reference.tum", out);
  expect_refusal({"convert", drive, file("out/f.txt")}, "f.txt", out);
  expect_refusal({"convert", drive, file("out")}, "there already", out);
  expect_refusal({"map", shared("run"), "-o", file("out")}, "no map that this program wrote", out);
  expect_refusal({"map", shared("run"), "-o", shared("run")}, "is read from it", *shared_ / "run");
  // A log of the same name would take the statements of a rawlog.
  ASSERT_EQ(run_program("convert " + drive + " " + file("out/g.rawlog")).status, 0);
  expect_refusal({"convert", drive, file("out/g.txt")}, "g.traverse.yaml belongs to g.rawlog", out);
  expect_refusal({"convert", drive, file("out/g.txt"), "--force"}, "belongs to g.rawlog", out);

  const ProgramResult forced =
      run_program("convert " + drive + " " + file("out/a.rawlog") + " --force");
  EXPECT_EQ(forced.status, 0) << forced.everything();
}

TEST_F(OutputSafety, AFileBesideAMapIsNotLostWithIt) {
  const std::string map = "map " + shared("run") + " --no-grid -o " + file("map");
  ASSERT_EQ(run_program(map).status, 0);
  EXPECT_EQ(run_program(map).status, 0) << "an earlier map is replaced";
  files::write_text(folder_ / "map/notes.txt", "foreign");
  expect_refusal({"map", shared("run"), "-o", file("map")}, "'notes.txt'", folder_ / "map");
}

TEST_F(OutputSafety, FilesOfAnEarlierSimulationThatAreNotMadeAgainGo) {
  const std::string street = "simulate town_short --duration 0.3 -o " + file("q.rawlog");
  ASSERT_EQ(run_program(street + " --set gnss.mounted=true").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "q.gnss.csv"));
  const ProgramResult second = run_program(street + " --set gnss.mounted=false");
  ASSERT_EQ(second.status, 0) << second.everything();
  EXPECT_FALSE(fs::exists(folder_ / "q.gnss.csv")) << "it would be taken for the new drive's";
}

/// \returns the exit status of a command of the shell.
int shell(const std::string& command) {
  const int status = std::system(("bash -c \"" + command + "\"").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
const std::string kProgram = TRAVERSE_PROGRAM;

TEST_F(OutputSafety, MessagesThatNobodyTakesEndNothing) {
  const std::string command = kProgram + joined(simulation_words(file("q.rawlog"), 2));
  ASSERT_EQ(shell(command + " > /dev/null 2>&1"), 0);
  const Digests expected = digests_of(folder_.path());
  for (const char* streams :
       {"> /dev/null 2>&-", "> /dev/null 2> /dev/full", ">&- 2>&-", "<&- >&- 2>&-"}) {
    EXPECT_EQ(shell(command + " " + streams), 0) << streams;
    EXPECT_EQ(digests_of(folder_.path()), expected) << streams;
  }
  EXPECT_EQ(shell("{ sleep 0.2; " + command + "; echo \\$? > " + shared("status") +
                  "; } 2>&1 > /dev/null | true"),
            0);
  EXPECT_EQ(files::read_text(shared("status")), "0\n");
  EXPECT_EQ(digests_of(folder_.path()), expected);
}

TEST_F(OutputSafety, ResultsThatAreNotTakenAreAFailure) {
  const std::string truth = shared("drive.reference.tum");
  const std::string plan = file("plan.yaml");
  files::write_text(
      plan, "recordings: [{path: " + shared("drive.rawlog") + "}]\npipelines: [{preset: floam}]\n");
  for (const std::string& command :
       {"info " + shared("drive.rawlog"), "evaluate " + truth + " --reference " + truth,
        "convert " + shared("drive.rawlog") + " " + file("q.rawlog"),
        "map " + shared("run") + " -o " + file("map"), std::string("map --settings"),
        "batch --check " + plan, std::string("pipelines"), std::string("pipelines traverse"),
        std::string("simulate --list"), std::string("--help"), std::string("run --help"),
        std::string("--version"), std::string("batch metrics")}) {
    EXPECT_EQ(shell(kProgram + " " + command + " > /dev/full 2> " + file("messages")), 1)
        << command << files::read_text(file("messages"));
    EXPECT_THAT(files::read_text(file("messages")), HasSubstr("standard output: cannot be written"))
        << command;
  }
}

TEST_F(OutputSafety, AReaderThatHasEnoughEndsTheCommandSilently) {
  for (const char* command : {"pipelines", "simulate --list", "--help"}) {
    EXPECT_EQ(shell("{ sleep 0.2; " + kProgram + " " + command + "; echo \\$? > " + file("status") +
                    "; } 2> " + file("messages") + " | true"),
              0);
    EXPECT_EQ(files::read_text(file("status")), "141\n") << command;  // 128 + SIGPIPE
    EXPECT_THAT(files::read_text(file("messages")), Not(HasSubstr("traverse:"))) << command;
  }
}

TEST_F(OutputSafety, ASignalThatIsIgnoredStaysIgnored) {
  const std::string command =
      kProgram + joined(simulation_words(file("q.rawlog"), 2)) + " > /dev/null 2>&1";
  EXPECT_EQ(shell("trap '' INT HUP; " + command + " & pid=\\$!; sleep 0.1; kill -INT \\$pid; " +
                  "kill -HUP \\$pid; wait \\$pid"),
            0);
}

#ifndef TRAVERSE_SANITIZED
TEST_F(OutputSafety, LackOfMemoryIsSaidInWords) {
  // Below the first limit the system does not even load the program, above the last all goes well.
  int failures = 0;
  for (int limit_kB = 400'000; limit_kB <= 900'000; limit_kB += 100'000) {
    const int status = shell("ulimit -v " + std::to_string(limit_kB) + "; " + kProgram +
                             " simulate town_large --duration 1 -o " + file("q.rawlog") +
                             " > /dev/null 2> " + file("messages"));
    const std::string messages = files::read_text(file("messages"));
    EXPECT_TRUE(status == 0 || status == 1 || status == 127) << status << messages;
    if (status == 1) {
      ++failures;
      EXPECT_THAT(messages, AllOf(HasSubstr("traverse: "), Not(HasSubstr("bad_alloc"))));
    }
  }
  EXPECT_GT(failures, 0);
}
#endif

/// A batch of three short runs.
constexpr const char* kPlan = R"(
recordings:
  - {simulate: town_short, arguments: {first: 30, duration: 0.3, sensor: vlp16}}
pipelines:
  - {preset: floam, set: {start.scans: 0, first_registration_steps: 2}}
repeats: 3
reports: false
limits: {time_s: 300, attempts: 20}
)";

class BatchOutput : public OutputSafety {
 protected:
  BatchOutput() {
    files::write_text(folder_ / "plan.yaml", kPlan);
    fs::create_directories(folder_ / "out/runs");
    files::write_text(folder_ / "out/notes.txt", "foreign");
    foreign_ = digests_of(folder_ / "out");
  }

  std::vector<std::string> words() const {
    return {"batch", file("plan.yaml"), "-o", file("out"), "--jobs", "2"};
  }
  /// Of foreign files and of finished runs.
  Digests lasting() const {
    static const std::regex kept("notes.txt|runs|runs/[0-9a-f]{16}(/.*)?");
    Digests digests = digests_of(folder_ / "out");
    std::erase_if(digests, [](const auto& file) { return !std::regex_match(file.first, kept); });
    return digests;
  }

  Digests foreign_;
};

TEST_F(BatchOutput, KilledAtAnyMomentForeignFilesAndFinishedRunsStay) {
  Digests known = foreign_;
  duration_ = std::chrono::milliseconds(600);
  for (int kill = 0; kill < kKills; ++kill) {
    ProgramProcess process(words(), folder_ / "log");
    wait_a_random_while();
    process.signal(SIGKILL);
    process.wait();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // its runs die with it
    const Digests now = lasting();
    ASSERT_THAT(now, IsSupersetOf(known));
    known = now;
  }
  const ProgramResult done = run_program(joined(words()));
  EXPECT_EQ(done.status, 0) << done.everything();
  EXPECT_THAT(lasting(), IsSupersetOf(known));
  for (const auto& [name, digest] : digests_of(folder_ / "out")) {
    EXPECT_THAT(name, Not(HasSubstr("partial")));
  }
}

TEST_F(BatchOutput, ASignalEndsItInOrder) {
  duration_ = std::chrono::milliseconds(500);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGINT, SIGTERM}) {
    ProgramProcess process(words(), folder_ / "log");
    process.wait_for_handlers();
    wait_a_random_while();
    process.signal(signal);
    const int status = process.wait();
    if (status == 0) break;  // all is done
    EXPECT_EQ(status, 128 + signal) << files::read_text(folder_ / "log");
    EXPECT_THAT(lasting(), IsSupersetOf(foreign_));
    for (const auto& [name, digest] : digests_of(folder_ / "out")) {
      EXPECT_THAT(name, Not(HasSubstr("partial")));
    }
  }
}

TEST_F(BatchOutput, AFileInItsWayIsNamedAndStays) {
  files::write_text(folder_ / "out/results.csv", "foreign");
  expect_refusal(words(), "results.csv", folder_ / "out");
  fs::remove(folder_ / "out/results.csv");
  files::write_text(folder_ / "out/lock", "foreign");
  expect_refusal(words(), "lock", folder_ / "out");
  fs::remove(folder_ / "out/lock");
  files::write_text(folder_ / "out/runs/notes.txt", "foreign");
  expect_refusal(words(), "runs", folder_ / "out");
}

TEST_F(BatchOutput, ThePlanMayBeKeptInItsFolder) {
  files::write_text(folder_ / "out/plan.yaml", kPlan);
  const ProgramResult done = run_program("batch " + file("out/plan.yaml") + " -o " + file("out"));
  EXPECT_EQ(done.status, 0) << done.everything();
  EXPECT_EQ(files::read_text(folder_ / "out/plan.yaml"), kPlan);
}

}  // namespace
}  // namespace traverse
