// In a program of its own: the peak that the system tells of a child counts what its parent held
// when it was started, so that the parent must be small.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace traverse {
namespace {

using testing::TemporaryFolder;

/// A drive of one metre a pose, up and down hills, with errors of a few centimetres where told.
void write_drive(const std::filesystem::path& file, std::size_t poses, double error) {
  std::ofstream stream(file);
  stream.precision(17);
  for (std::size_t i = 0; i < poses; ++i) {
    const auto s = static_cast<double>(i);
    const double half = 0.25 * std::sin(2e-3 * s) + 0.01 * error * std::sin(s);
    stream << 1'300'000'000 + i / 10 << '.' << i % 10 << ' ' << s + error * std::sin(3 * s) << ' '
           << 40 * std::sin(1e-2 * s) << ' ' << error * std::cos(5 * s) << " 0 0 " << std::sin(half)
           << ' ' << std::cos(half) << '\n';
  }
}

double peak_bytes(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

/// The most memory that `traverse evaluate` of so many poses held at a time, bytes.
double peak_of_evaluation(std::size_t poses, const std::string& more_options) {
  const TemporaryFolder folder;
  write_drive(folder / "estimate.tum", poses, 0.05);
  write_drive(folder / "reference.tum", poses, 0);
  const std::string command = std::string("exec ") + TRAVERSE_PROGRAM + " evaluate '" +
                              (folder / "estimate.tum").string() + "' --reference '" +
                              (folder / "reference.tum").string() +
                              "' --align se3 --rpe 10f --rpe 100m " + more_options + " > '" +
                              (folder / "table").string() + "'";
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  EXPECT_EQ(::wait4(child, &status, 0, &usage), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command;
  const double peak = static_cast<double>(usage.ru_maxrss) * 1024;
  EXPECT_GT(peak, peak_bytes(RUSAGE_SELF)) << "it is this test's own memory that was measured";
  return peak;
}

double bytes_a_pose(const std::string& more_options = "") {
  constexpr std::size_t kFew = 80'000;
  constexpr std::size_t kMany = 240'000;
  const double few = peak_of_evaluation(kFew, more_options);
  const double many = peak_of_evaluation(kMany, more_options);
  const double slope = (many - few) / static_cast<double>(kMany - kFew);
  std::printf("%zu poses %.0f MB, %zu poses %.0f MB: %.0f bytes a pose %s\n", kFew, few / 1e6,
              kMany, many / 1e6, slope, more_options.c_str());
  return slope;
}

TEST(EvaluateMemory, IsAtMostAFifthOfAKilobyteAPose) {
#ifdef TRAVERSE_SANITIZED
  GTEST_SKIP() << "a sanitizer keeps what was freed";
#endif
  EXPECT_LE(bytes_a_pose(), 200);
}

TEST(EvaluateMemory, IsThatWithADocumentTooWhichIsWrittenAsItIsMade) {
#ifdef TRAVERSE_SANITIZED
  GTEST_SKIP() << "a sanitizer keeps what was freed";
#endif
  const TemporaryFolder folder;
  EXPECT_LE(bytes_a_pose("--json '" + (folder / "evaluation.json").string() + "'"), 200);
}

}  // namespace
}  // namespace traverse
