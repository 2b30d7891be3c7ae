#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "traverse/optimization/jacobian_audit.hpp"

namespace traverse::optimization {

namespace {

using Json = nlohmann::ordered_json;

double number(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Json to_json(const JacobianDifference& difference) {
  return {{"absolute", difference.absolute},
          {"relative", difference.relative},
          {"worst_state", difference.worst_state}};
}

JacobianDifference difference_from(const Json& json) {
  return {number(json.at("absolute")), number(json.at("relative")), json.at("worst_state")};
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
          {"least_residual", factor.least_residual},
          {"value_difference", factor.value_difference},
          {"blocks", std::move(blocks)}};
}

Perturbation perturbation_from(const Json& json) {
  const std::string name = json;
  for (const auto& [known, value] : kPerturbationNames) {
    if (known == name) return value;
  }
  throw std::runtime_error("no perturbation is called '" + name + "'");
}

FactorAudit factor_from(const Json& json) {
  FactorAudit factor;
  factor.factor = json.at("factor");
  factor.formula = json.at("formula");
  factor.perturbation = perturbation_from(json.at("perturbation"));
  factor.passed = json.at("passed");
  factor.least_residual = number(json.at("least_residual"));
  factor.value_difference = number(json.at("value_difference"));
  for (const Json& block : json.at("blocks")) {
    factor.blocks.push_back({block.at("block"), number(block.at("largest_entry")),
                             difference_from(block.at("automatic")),
                             difference_from(block.at("numeric")), block.at("passed")});
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
                  {"least_residual", audit.options.least_residual},
                  {"tolerance",
                   {{"automatic", audit.options.automatic_tolerance},
                    {"numeric", audit.options.numeric_tolerance}}},
                  {"factors", std::move(factors)}};
  return json.dump(1) + "\n";
}

JacobianAudit audit_from_json(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    JacobianAudit audit;
    audit.options = {json.at("states"), json.at("seed"), json.at("least_residual"),
                     json.at("tolerance").at("automatic"), json.at("tolerance").at("numeric")};
    for (const Json& factor : json.at("factors")) audit.factors.push_back(factor_from(factor));
    return audit;
  } catch (const Json::exception& error) {
    throw std::runtime_error(error.what());
  }
}

}  // namespace traverse::optimization
