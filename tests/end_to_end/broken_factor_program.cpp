// `check-jacobians` as in the program itself, but with a factor whose Jacobian is wrong.

#include <CLI/CLI.hpp>

#include "check_jacobians.hpp"
#include "exit_status.hpp"
#include "optimization/broken_factor.hpp"

int main(int argc, char** argv) {
  using traverse::optimization::Perturbation;
  CLI::App app{"Traverse with a broken factor", "traverse"};
  app.require_subcommand(1);
  traverse::app::add_check_jacobians(app,
                                     {traverse::testing::turned_point_kind(Perturbation::kRight)});
  return traverse::app::exit_status(app, argc, argv);
}
