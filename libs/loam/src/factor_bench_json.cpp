#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "traverse/loam/factor_bench.hpp"

namespace traverse::loam {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Spread& spread) {
  return {{"median", spread.median},
          {"lower_quartile", spread.lower_quartile},
          {"upper_quartile", spread.upper_quartile}};
}

Spread spread_from(const Json& json) {
  return {json.at("median"), json.at("lower_quartile"), json.at("upper_quartile")};
}

optimization::Derivative derivative_from(const Json& json) {
  const std::string name = json;
  for (const auto& [known, value] : optimization::kDerivativeNames) {
    if (known == name) return value;
  }
  throw std::runtime_error("no derivative is called '" + name + "'");
}

}  // namespace

std::string to_json(const FactorBench& bench) {
  Json evaluations = Json::array();
  for (const EvaluationCost& cost : bench.evaluations) {
    evaluations.push_back({{"factor", cost.factor},
                           {"derivative", name_of(cost.derivative)},
                           {"residuals", cost.residuals},
                           {"nanoseconds", to_json(cost.nanoseconds)}});
  }
  Json solves = Json::array();
  for (const SolveCost& cost : bench.solves) {
    solves.push_back({{"factors", cost.factors},
                      {"derivative", name_of(cost.derivative)},
                      {"iterations", cost.iterations},
                      {"milliseconds", to_json(cost.milliseconds)},
                      {"from_analytic_m", cost.from_analytic_m},
                      {"from_analytic_rad", cost.from_analytic_rad}});
  }
  const Json json{{"recording", bench.recording}, {"frame", bench.frame},
                  {"lines", bench.lines},         {"planes", bench.planes},
                  {"repeats", bench.repeats},     {"evaluations", std::move(evaluations)},
                  {"solves", std::move(solves)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

FactorBench factor_bench_from_json(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    FactorBench bench;
    bench.recording = json.at("recording");
    bench.frame = json.at("frame");
    bench.lines = json.at("lines");
    bench.planes = json.at("planes");
    bench.repeats = json.at("repeats");
    for (const Json& cost : json.at("evaluations")) {
      bench.evaluations.push_back({cost.at("factor"), derivative_from(cost.at("derivative")),
                                   cost.at("residuals"), spread_from(cost.at("nanoseconds"))});
    }
    for (const Json& cost : json.at("solves")) {
      bench.solves.push_back({cost.at("factors"), derivative_from(cost.at("derivative")),
                              cost.at("iterations"), spread_from(cost.at("milliseconds")),
                              cost.at("from_analytic_m"), cost.at("from_analytic_rad")});
    }
    return bench;
  } catch (const Json::exception& error) {
    throw std::runtime_error(error.what());
  }
}

}  // namespace traverse::loam
