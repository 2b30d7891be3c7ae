#include "traverse/config/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/config/document.hpp"

#include "config/example_options.hpp"

namespace traverse::config {
namespace {

TEST(Settings, ListNamesEverySettingWithItsPath) {
  ExampleOptions options;
  const auto settings = list(binding(options));
  ASSERT_EQ(settings.size(), 7U);
  EXPECT_EQ(settings[0].path, "threshold");
  EXPECT_EQ(settings[0].allowed, "0 .. 1");
  EXPECT_EQ(settings[5].allowed, "vector | scalar");
  EXPECT_EQ(settings[6].path, "inner.gate_m");
  EXPECT_EQ(std::get<double>(settings[6].value), 1);
}

TEST(Settings, YamlReadsBackToTheSameOptions) {
  ExampleOptions written;
  written.threshold = 1.0 / 3;
  written.label = "yes: #1";
  written.form = Form::kScalar;
  written.angles = {};
  written.inner_gate_m = 1e-7;
  ExampleOptions read_back;
  read(Document::parse(to_yaml(binding(written), true), "x.yaml"), binding(read_back));
  EXPECT_EQ(read_back.threshold, written.threshold);
  EXPECT_EQ(read_back.label, written.label);
  EXPECT_EQ(read_back.form, written.form);
  EXPECT_EQ(read_back.angles, written.angles);
  EXPECT_EQ(read_back.inner_gate_m, written.inner_gate_m);
}

struct Limits {
  int min_matches = 10;
  double max_range_m = 80;
};

std::vector<std::string> read_limits(const std::string& yaml, Limits& limits) {
  return read(Document::parse(yaml, "mine.yaml"), [&](Binder& b) {
    b.group("solver", "of poses", [&](Binder& g) {
      g.integer("min_matches", limits.min_matches, Range::between(1, 100), "for a solution");
      g.number("max_range_m", limits.max_range_m, Range::positive(), "of points");
    });
  });
}

TEST(Settings, LimitsAreTakenByTheirFormerNamesWithANote) {
  Limits limits;
  const auto notes = read_limits("solver:\n  least_matches: 20\n  most_range_m: 50\n", limits);
  EXPECT_EQ(limits.min_matches, 20);
  EXPECT_EQ(limits.max_range_m, 50);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[0],
            "mine.yaml, line 2: 'solver.least_matches' is called 'solver.min_matches' now");
}

TEST(Settings, TheNewNameOfALimitWins) {
  Limits limits;
  const auto notes = read_limits("solver: {min_matches: 7, least_matches: 20}", limits);
  EXPECT_EQ(limits.min_matches, 7);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], testing::HasSubstr("which is given too and wins"));
}

}  // namespace
}  // namespace traverse::config
