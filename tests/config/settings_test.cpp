#include "traverse/config/settings.hpp"

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

}  // namespace
}  // namespace traverse::config
