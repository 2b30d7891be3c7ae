#include "check_jacobians.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/optimization/shown_jacobians.hpp"
#include "traverse/pipeline/factor_kinds.hpp"

#include "commands.hpp"
#include "json_output.hpp"
#include "table.hpp"

namespace traverse::app {

namespace {

constexpr const char* kCheckJacobiansExamples = R"(Example:
  traverse check-jacobians --states 1000 --seed 7 --json jacobians.json
  traverse check-jacobians --factor inertial --show
  traverse check-jacobians --show --run RUN --frame 200

Each factor's analytic Jacobian is compared at random states, away from zero residual, with the
automatic one (dual numbers) and with central differences of the factor's own value, for a rotation
moved on the right, R Exp(d), and on the left, Exp(d) R. Of all states the largest difference of an
entry is shown, and the largest relative to the block's largest entry, which decides. Exit status 1 if
a block fails. docs/mathematics.md derives what is checked.)";

/// What the exercises call the factors of their chapter.
const std::map<std::string, std::vector<std::string>> kGroups{
    {"inertial", {"inertial rotation", "inertial velocity", "inertial position"}},
    {"lidar", {"line vector", "line scalar", "plane absolute", "plane signed"}}};

struct CheckJacobiansArguments {
  std::vector<optimization::FactorKind> kinds;
  optimization::AuditOptions options;
  std::optional<std::filesystem::path> json;
  std::string factor;
  bool is_shown = false;
  std::string run;  ///< whose states are shown in place of random ones
  std::size_t frame = 0;
};

std::string difference_text(double value) {
  return value == 0 ? "0" : fmt::format("{:.1e}", value);
}

std::string table_text(const optimization::JacobianAudit& audit) {
  using Align = Table::Align;
  Table table({{Align::kLeft},
               {Align::kLeft},
               {Align::kLeft},
               {Align::kRight},
               {Align::kRight},
               {Align::kRight},
               {Align::kRight},
               {Align::kRight},
               {Align::kLeft}});
  table.add_row({"", "", "", "largest", "automatic", "", "differences", "", ""});
  table.add_row({"factor", "perturbation", "block", "entry", "absolute", "relative", "absolute",
                 "relative", ""});
  for (const optimization::FactorAudit& factor : audit.factors) {
    for (const optimization::BlockAudit& block : factor.blocks) {
      table.add_row(
          {factor.factor, std::string(name_of(factor.perturbation)), block.block,
           fmt::format("{:.3g}", block.largest_entry), difference_text(block.automatic.absolute),
           difference_text(block.automatic.relative), difference_text(block.numeric.absolute),
           difference_text(block.numeric.relative), block.passed ? "pass" : "FAIL"});
    }
  }
  return table.text(0);
}

/// What failed, one line a block; a value that differs is told of its factor.
std::string failures(const optimization::JacobianAudit& audit) {
  std::string text;
  for (const optimization::FactorAudit& factor : audit.factors) {
    const std::string name =
        fmt::format("{}, {} perturbation", factor.factor, name_of(factor.perturbation));
    if (!(factor.value_difference <= audit.options.automatic_tolerance)) {
      text += fmt::format("\n  {}: the value differs from that of the automatic form by {:.1e}",
                          name, factor.value_difference);
    }
    for (const optimization::BlockAudit& block : factor.blocks) {
      if (block.passed) continue;
      text += fmt::format("\n  {}, {}: off by {:.1e} of its largest entry (state {})", name,
                          block.block, block.numeric.relative, block.numeric.worst_state);
    }
  }
  return text;
}

/// Those that --factor asks for. \throws std::invalid_argument if it is the name of none.
std::vector<optimization::FactorKind> chosen(const CheckJacobiansArguments& arguments) {
  if (arguments.factor.empty()) return arguments.kinds;
  const auto group = kGroups.find(arguments.factor);
  const std::vector<std::string> names =
      group == kGroups.end() ? std::vector{arguments.factor} : group->second;
  std::vector<optimization::FactorKind> kinds;
  for (const auto& kind : arguments.kinds) {
    if (std::find(names.begin(), names.end(), kind.name) != names.end()) kinds.push_back(kind);
  }
  if (kinds.empty()) {
    throw std::invalid_argument(
        fmt::format("--factor: no factor is called '{}': inertial, lidar or one of the names that "
                    "`traverse check-jacobians` lists",
                    arguments.factor));
  }
  return kinds;
}

/// The entries of a matrix beside those of another and their difference, a row a line.
std::string blocks_text(const optimization::ShownBlock& block) {
  const auto entries = [](const Eigen::MatrixXd& matrix, Eigen::Index row, const char* form) {
    std::string text;
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      text += fmt::format(fmt::runtime(form), matrix(row, column));
    }
    return text;
  };
  std::string text;
  for (Eigen::Index row = 0; row < block.analytic.rows(); ++row) {
    text += fmt::format("  {}  |{}  |{}  |{}\n", entries(block.analytic, row, "{:12.6f}"),
                        entries(block.automatic, row, "{:12.6f}"),
                        entries(block.numeric, row, "{:12.6f}"),
                        entries(block.analytic - block.numeric, row, "{:10.1e}"));
  }
  return text;
}

void show_jacobians(const CheckJacobiansArguments& arguments) {
  if (!arguments.run.empty()) {
    fmt::print("At frames {} and {} of {}, between them a constant rate and acceleration\n\n",
               arguments.frame - 1, arguments.frame, arguments.run);
  }
  for (const auto& kind : chosen(arguments)) {
    for (const auto perturbation : kind.perturbations) {
      const auto shown = optimization::show_jacobians(kind, perturbation, arguments.options);
      fmt::print("{}, {} perturbation: {}\n\n", shown.factor, name_of(perturbation), shown.formula);
      for (const auto& block : shown.blocks) {
        const Eigen::MatrixXd difference = block.analytic - block.numeric;
        fmt::print("{}: analytic | automatic | numeric | analytic - numeric (at most {:.1e})\n{}\n",
                   pipeline::book_name(shown.factor, block.block), difference.cwiseAbs().maxCoeff(),
                   blocks_text(block));
      }
    }
  }
}

void check_jacobians(const CheckJacobiansArguments& given) {
  CheckJacobiansArguments arguments = given;
  if (!arguments.run.empty()) {
    arguments.kinds = pipeline::factor_kinds_of_run({arguments.run}, arguments.frame);
    arguments.options.states = 1;
    arguments.options.min_residual = 0;  // a run's states agree with what was measured
    arguments.is_shown = true;
  }
  if (arguments.is_shown) {
    show_jacobians(arguments);
    return;
  }
  const auto audit = optimization::audit_jacobians(chosen(arguments), arguments.options);
  fmt::print(
      "Analytic Jacobians against automatic ones and central differences, {} random states "
      "(seed {})\n\n{}\n",
      audit.options.states, audit.options.seed, table_text(audit));
  if (arguments.json) write_json_output(*arguments.json, to_json(audit));
  if (!audit.passed()) {
    fmt::print("FAIL\n");
    throw std::runtime_error("Jacobians are wrong:" + failures(audit));
  }
  fmt::print("PASS: all within {:.0e} of automatic derivatives and {:.0e} of differences\n",
             audit.options.automatic_tolerance, audit.options.numeric_tolerance);
}

}  // namespace

void add_check_jacobians(CLI::App& app, std::vector<optimization::FactorKind> kinds) {
  CLI::App* command = app.add_subcommand(
      "check-jacobians", "compare every factor's analytic Jacobian with two others");
  const auto arguments = std::make_shared<CheckJacobiansArguments>();
  arguments->kinds = std::move(kinds);
  command
      ->add_option("--states", arguments->options.states,
                   "random instances of each factor and perturbation")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.seed, "of the random states")
      ->capture_default_str();
  command->add_option("--factor", arguments->factor,
                      "these alone: inertial, lidar, or the name of one");
  command->add_flag(
      "--show", arguments->is_shown,
      "print the Jacobians at the first state, analytic beside automatic and numeric");
  auto* run = command
                  ->add_option("--run", arguments->run,
                               "show the inertial factor at a frame of this navigation run")
                  ->type_name("RUN");
  command
      ->add_option("--frame", arguments->frame,
                   "of the run, as frames.csv counts them: the factor from the one before to it")
      ->check(CLI::PositiveNumber)
      ->needs(run);
  command->add_option("--json", arguments->json, "write every figure to this file")
      ->type_name("FILE");
  command->footer(kCheckJacobiansExamples);
  command->callback([arguments] { check_jacobians(*arguments); });
}

void add_check_jacobians(CLI::App& app) { add_check_jacobians(app, pipeline::factor_kinds()); }

}  // namespace traverse::app
