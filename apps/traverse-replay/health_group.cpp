#include "health_group.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanogui/label.h>
#include <nanogui/layout.h>
#include <nanogui/screen.h>

#include <fmt/format.h>

namespace traverse::app {

namespace {

/// Of the known estimators' columns those that tell most; of others the first ones are shown.
constexpr std::array<const char*, 9> kTelling{
    "registered",     "line_matches", "plane_matches",
    "residual_rms_m", "inlier_share", "degenerate_directions",
    "eigenvalue_1",   "map_points",   "speed_mps"};
constexpr std::size_t kMostRows = 9;

std::string value_text(const std::string& column, double value) {
  if (column == "registered") return value != 0 ? "yes" : "no";
  if (std::isnan(value)) return "-";
  if (value == std::round(value) && std::abs(value) < 1e9) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

/// "residual_rms_m" as people read it: "residual rms [m]".
std::string title_of(std::string column) {
  for (const auto& [suffix, unit] : {std::pair{"_mps", " [m/s]"}, std::pair{"_m", " [m]"},
                                     std::pair{"_ms", " [ms]"}, std::pair{"_deg", " [deg]"}}) {
    if (column.ends_with(suffix)) {
      column = column.substr(0, column.size() - std::string_view(suffix).size()) + unit;
      break;
    }
  }
  std::replace(column.begin(), column.end(), '_', ' ');
  return column;
}

}  // namespace

HealthGroup::HealthGroup(nanogui::Widget* parent, Console& console)
    : FoldingGroup(parent, "Health of the frame", true), console_(console) {
  table_ = new nanogui::Widget(content());
  auto* layout =
      new nanogui::GridLayout(nanogui::Orientation::Horizontal, 2, nanogui::Alignment::Fill, 0, 1);
  table_->setLayout(layout);
}

void HealthGroup::choose_rows() {
  columns_ = console_.player().columns();
  std::vector<std::string> chosen;
  for (const char* column : kTelling) {
    if (std::find(columns_.begin(), columns_.end(), column) != columns_.end()) {
      chosen.emplace_back(column);
    }
  }
  for (const std::string& column : columns_) {
    if (chosen.size() >= kMostRows || (!chosen.empty() && chosen.front() == kTelling[0])) break;
    if (std::find(chosen.begin(), chosen.end(), column) == chosen.end()) chosen.push_back(column);
  }
  while (table_->childCount() > 0) table_->removeChild(table_->childCount() - 1);
  rows_.clear();
  for (const std::string& column : chosen) {
    Row row{column, new nanogui::Label(table_, title_of(column)), new nanogui::Label(table_, "-")};
    row.name->setFixedWidth(170);
    row.value->setFixedWidth(90);
    row.name->setTooltip("Column '" + column + "' of frames.csv; see docs/run-folder.md");
    rows_.push_back(row);
  }
  screen()->performLayout();
}

void HealthGroup::refresh() {
  if (columns_ != console_.player().columns()) choose_rows();
  const auto shown = console_.player().shown();
  for (Row& row : rows_) {
    const auto place = static_cast<std::size_t>(
        std::find(columns_.begin(), columns_.end(), row.column) - columns_.begin());
    const bool known = shown && place < shown->pose.record.size();
    row.value->setCaption(known ? value_text(row.column, shown->pose.record[place]) : "-");
  }
}

}  // namespace traverse::app
