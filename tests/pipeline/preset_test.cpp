#include "traverse/pipeline/preset.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/pipeline/registry.hpp"

#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

const ResolvedSetting& find(const std::vector<ResolvedSetting>& settings, const std::string& key) {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const auto& s) { return s.setting.path == key; });
  if (found == settings.end()) throw std::runtime_error("no setting " + key);
  return *found;
}

std::string error_of(const PresetRequest& request) {
  try {
    resolve_settings(load_preset(request, TRAVERSE_SHARE_DIR));
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Preset, EveryShippedPresetIsValidAndDescribed) {
  const auto presets = list_presets(TRAVERSE_SHARE_DIR);
  EXPECT_FALSE(presets.empty());
  for (const PresetSummary& summary : presets) {
    EXPECT_FALSE(summary.description.empty()) << summary.name;
    const Preset preset = load_preset({summary.name, {}, {}}, TRAVERSE_SHARE_DIR);
    for (const ResolvedSetting& setting : resolve_settings(preset)) {
      EXPECT_FALSE(setting.is_changed()) << setting.setting.path;
      EXPECT_FALSE(setting.setting.meaning.empty()) << setting.setting.path;
    }
  }
}

TEST(Preset, FilesAndAssignmentsLieOverItAndAreMarked) {
  const TemporaryFolder folder;
  files::write_text(folder / "mine.yaml", "solver:\n  huber_m: 0.3\nmap: {radius_m: 50}\n");
  const Preset preset =
      load_preset({"floam", {folder / "mine.yaml"}, {"solver.huber_m=0.2"}}, TRAVERSE_SHARE_DIR);
  const auto settings = resolve_settings(preset);
  EXPECT_EQ(std::get<double>(find(settings, "solver.huber_m").setting.value), 0.2);
  EXPECT_EQ(std::get<double>(find(settings, "solver.huber_m").in_preset), 0.1);
  EXPECT_TRUE(find(settings, "map.radius_m").is_changed());
  EXPECT_FALSE(find(settings, "map.edge_voxel_m").is_changed());
}

TEST(Preset, AFileInTheFormOfAPresetIsOne) {
  const TemporaryFolder folder;
  files::write_text(folder / "own.yaml", "estimator: scan_to_map\ndeskew: false\n");
  const Preset preset = load_preset({(folder / "own.yaml").string(), {}, {}}, TRAVERSE_SHARE_DIR);
  EXPECT_EQ(preset.name, "own");
  EXPECT_FALSE(std::get<bool>(find(resolve_settings(preset), "deskew").setting.value));
}

TEST(Preset, SaysWhatIsWrong) {
  EXPECT_THAT(error_of({"flaom", {}, {}}),
              HasSubstr("one of aloam, floam, gins-book, gins-gnss, gins-odom, gins-odom-paired, "
                        "gins-phone, gins-window, loam, traverse, traverse-inertial"));
  EXPECT_THAT(error_of({"floam", {}, {"solver.huber=1"}}),
              HasSubstr("did you mean 'solver.huber_m'"));
  EXPECT_THAT(error_of({"floam", {}, {"solver.huber_m=-1"}}), HasSubstr("above 0"));
  EXPECT_THAT(error_of({"floam", {}, {"estimator=magic"}}),
              HasSubstr("gins_two_frame, gins_window, imported_poses, localize_"));
  const TemporaryFolder folder;
  files::write_text(folder / "mine.yaml", "\nsolver:\n  huber_m: wide\n");
  EXPECT_THAT(error_of({"floam", {folder / "mine.yaml"}, {}}), HasSubstr("mine.yaml, line 3"));
}

}  // namespace
}  // namespace traverse::pipeline
