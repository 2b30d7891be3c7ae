#pragma once

#include <string>
#include <utility>
#include <vector>

#include "run/model.hpp"

namespace traverse::report {

inline Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(series_number(value));
  return list;
}

/// A chart of docs/report-json.md.
class Chart {
 public:
  Chart(std::string id, std::string section, std::string title, std::string unit) {
    json_ = {{"id", std::move(id)},       {"section", std::move(section)},
             {"title", std::move(title)}, {"unit", std::move(unit)},
             {"pose", nullptr},           {"x", nullptr},
             {"x_name", nullptr},         {"log", false},
             {"stacked", false},          {"points", false},
             {"level", nullptr},          {"series", Json::array()}};
  }

  Chart& series(const std::string& name, const std::vector<double>& values) {
    json_["series"].push_back({{"name", name}, {"values", numbers(values)}});
    return *this;
  }
  /// The same with a band of so much to both sides of each value; of all series of a chart or none.
  Chart& series(const std::string& name, const std::vector<double>& values,
                const std::vector<double>& band) {
    json_["series"].push_back(
        {{"name", name}, {"values", numbers(values)}, {"band", numbers(band)}});
    return *this;
  }
  /// The poses that the values belong to; all of them, in order, if it is not called.
  Chart& poses(const std::vector<std::size_t>& poses) {
    json_["pose"] = poses;
    return *this;
  }
  /// Another axis than time and distance.
  Chart& x(const std::string& name, const std::vector<double>& values) {
    json_["x"] = numbers(values);
    json_["x_name"] = name;
    return *this;
  }
  Chart& level(const std::string& name, double value) {
    json_["level"] = {{"name", name}, {"value", value}};
    return *this;
  }
  Chart& flag(const char* name) {
    json_[name] = true;
    return *this;
  }
  Json take() { return std::move(json_); }

 private:
  Json json_;
};

}  // namespace traverse::report
