#include <cstdint>
#include <limits>
#include <string>

#include <nlohmann/json.hpp>

#include "traverse/files/json_document.hpp"
#include "traverse/optimization/jacobian_audit.hpp"

namespace traverse::optimization {

namespace {

using Json = nlohmann::ordered_json;
using files::JsonValue;

Json to_json(const JacobianDifference& difference) {
  return {{"absolute", difference.absolute},
          {"relative", difference.relative},
          {"worst_state", difference.worst_state}};
}

JacobianDifference difference_from(const JsonValue& json) {
  return {json["absolute"].number_or_nan(), json["relative"].number_or_nan(),
          json["worst_state"].count()};
}

Json to_json(const FactorAudit& factor) {
  Json blocks = Json::array();
  for (const BlockAudit& block : factor.blocks) {
    blocks.push_back({{"block", block.block},
                      {"passed", block.passed},
                      {"largest_entry", block.largest_entry},
                      {"automatic", to_json(block.automatic)},
                      {"numeric", to_json(block.numeric)}});
  }
  return {{"factor", factor.factor},
          {"formula", factor.formula},
          {"perturbation", name_of(factor.perturbation)},
          {"passed", factor.passed},
          {"min_residual", factor.min_residual},
          {"value_difference", factor.value_difference},
          {"blocks", std::move(blocks)}};
}

Perturbation perturbation_from(const JsonValue& json) {
  const std::string name = json.text();
  for (const auto& [known, value] : kPerturbationNames) {
    if (known == name) return value;
  }
  throw json.error("left or right");
}

/// Folders written by version 0.1 say least_residual.
JsonValue min_residual_of(const JsonValue& json) {
  return json[json.has("least_residual") ? "least_residual" : "min_residual"];
}

FactorAudit factor_from(const JsonValue& json) {
  FactorAudit factor;
  factor.factor = json["factor"].text();
  factor.formula = json["formula"].text();
  factor.perturbation = perturbation_from(json["perturbation"]);
  factor.passed = json["passed"].boolean();
  factor.min_residual = min_residual_of(json).number_or_nan();
  factor.value_difference = json["value_difference"].number_or_nan();
  const JsonValue blocks = json["blocks"];
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const JsonValue block = blocks[i];
    factor.blocks.push_back({block["block"].text(), block["largest_entry"].number_or_nan(),
                             difference_from(block["automatic"]), difference_from(block["numeric"]),
                             block["passed"].boolean()});
  }
  return factor;
}

}  // namespace

std::string to_json(const JacobianAudit& audit) {
  Json factors = Json::array();
  for (const FactorAudit& factor : audit.factors) factors.push_back(to_json(factor));
  const Json json{{"passed", audit.passed()},
                  {"states", audit.options.states},
                  {"seed", audit.options.seed},
                  {"min_residual", audit.options.min_residual},
                  {"tolerance",
                   {{"automatic", audit.options.automatic_tolerance},
                    {"numeric", audit.options.numeric_tolerance}}},
                  {"factors", std::move(factors)}};
  return json.dump(1) + "\n";
}

JacobianAudit audit_from_json(const JsonValue& json) {
  JacobianAudit audit;
  audit.options.states = json["states"].count();
  const std::size_t seed = json["seed"].count();
  if (seed > std::numeric_limits<std::uint32_t>::max())
    throw json["seed"].error("a seed of 32 bits");
  audit.options.seed = static_cast<std::uint32_t>(seed);
  audit.options.min_residual = min_residual_of(json).number();
  audit.options.automatic_tolerance = json["tolerance"]["automatic"].number();
  audit.options.numeric_tolerance = json["tolerance"]["numeric"].number();
  const JsonValue factors = json["factors"];
  for (std::size_t i = 0; i < factors.size(); ++i) audit.factors.push_back(factor_from(factors[i]));
  return audit;
}

}  // namespace traverse::optimization
