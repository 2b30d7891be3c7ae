#include <string>

#include <nlohmann/json.hpp>

#include "traverse/files/json_document.hpp"
#include "traverse/files/sealed_json.hpp"
#include "traverse/loam/factor_bench.hpp"

namespace traverse::loam {

namespace {

using Json = nlohmann::ordered_json;
using files::JsonValue;

Json to_json(const Spread& spread) {
  return {{"median", spread.median},
          {"lower_quartile", spread.lower_quartile},
          {"upper_quartile", spread.upper_quartile}};
}

Spread spread_from(const JsonValue& json) {
  return {json["median"].number(), json["lower_quartile"].number(),
          json["upper_quartile"].number()};
}

/// The costs of a case stand in the order of the derivatives, which tables and readers rely on.
optimization::Derivative derivative_from(const JsonValue& json, std::size_t place) {
  const auto& [name, derivative] =
      optimization::kDerivativeNames[place % optimization::kDerivativeNames.size()];
  if (json.text() != name) throw json.error(std::string(name));
  return derivative;
}

}  // namespace

FactorBench factor_bench_from_json(const JsonValue& json) {
  FactorBench bench;
  bench.recording = json["recording"].text();
  bench.frame = json["frame"].count();
  bench.lines = json["lines"].count();
  bench.planes = json["planes"].count();
  bench.repeats = json["repeats"].small_integer();
  const JsonValue evaluations = json["evaluations"];
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    const JsonValue cost = evaluations[i];
    bench.evaluations.push_back({cost["factor"].text(), derivative_from(cost["derivative"], i),
                                 cost["residuals"].count(), spread_from(cost["nanoseconds"])});
  }
  const JsonValue solves = json["solves"];
  for (std::size_t i = 0; i < solves.size(); ++i) {
    const JsonValue cost = solves[i];
    bench.solves.push_back({cost["factors"].texts(), derivative_from(cost["derivative"], i),
                            cost["iterations"].small_integer(), spread_from(cost["milliseconds"]),
                            cost["from_analytic_m"].number(), cost["from_analytic_rad"].number()});
  }
  return bench;
}

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
  return files::sealed_json(json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace traverse::loam
