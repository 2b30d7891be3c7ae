#include "traverse/pipeline/provenance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::pipeline {
namespace {

using ::testing::MatchesRegex;

TEST(Provenance, NamesProgramAndLibraries) {
  const BuildInfo build = build_info();
  EXPECT_THAT(build.version, MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_FALSE(build.commit.empty());
  for (const auto& [name, version] : build.libraries) {
    EXPECT_THAT(version, MatchesRegex("[0-9]+[0-9.]*")) << name;
  }
}

TEST(Provenance, NamesTheMachine) {
  const HostInfo host = host_info();
  EXPECT_FALSE(host.name.empty());
  EXPECT_NE(host.cpu, "unknown");
  EXPECT_GT(host.logical_cpus, 0);
  EXPECT_GT(host.memory_gb, 0.1);
  EXPECT_GT(peak_memory_mb(), 1);
}

TEST(Provenance, TimeIsUtcInIsoForm) {
  EXPECT_THAT(utc_now(), MatchesRegex("20[0-9][0-9]-[0-9]+-[0-9]+T[0-9]+:[0-9]+:[0-9]+Z"));
}

}  // namespace
}  // namespace traverse::pipeline
