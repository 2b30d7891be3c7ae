#include "recording_formats_report.hpp"

#include <nlohmann/json.hpp>

#include "traverse/dataset/recording_formats.hpp"

#include "table.hpp"

namespace traverse::app {

std::string recording_formats_text() {
  Table table({{}, {Table::Align::kLeft, 44}, {Table::Align::kLeft, 54}});
  table.add_row({"format", "recognised as", "what it holds"});
  for (const dataset::RecordingFormat& format : dataset::recording_formats()) {
    table.add_row({std::string(format.name), std::string(format.recognised_by),
                   std::string(format.description)});
  }
  return table.text(0);
}

std::string recording_formats_json() {
  nlohmann::ordered_json formats = nlohmann::ordered_json::array();
  for (const dataset::RecordingFormat& format : dataset::recording_formats()) {
    formats.push_back({{"name", format.name},
                       {"is_folder", format.is_folder},
                       {"recognised_by", format.recognised_by},
                       {"description", format.description}});
  }
  return nlohmann::ordered_json{{"formats", std::move(formats)}}.dump(2) + "\n";
}

}  // namespace traverse::app
