#include "sections/inertial_jacobians.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/optimization/shown_jacobians.hpp"
#include "traverse/pipeline/factor_kinds.hpp"

namespace traverse::report {

namespace {

/// The first frame from the middle on that the IMU led to from the one before it; its number.
std::optional<std::size_t> frame_to_show(const RunData& run) {
  const std::vector<double> numbers = run.frames.column("frame");
  const std::vector<double> restarted = run.frames.column("restarted");
  for (std::size_t row = std::max<std::size_t>(1, numbers.size() / 2); row < numbers.size();
       ++row) {
    const bool is_linked = restarted.empty() || restarted[row] == 0;
    if (is_linked && run.estimate.stamp(row) > run.estimate.stamp(row - 1)) {
      return static_cast<std::size_t>(numbers[row]);
    }
  }
  return std::nullopt;
}

/// A row of a block a line.
void add_block(const std::string& name, const optimization::ShownBlock& block, Table& table) {
  static constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  for (Eigen::Index row = 0; row < block.analytic.rows(); ++row) {
    std::vector<page::Cell> cells{name, kAxes.at(static_cast<std::size_t>(row))};
    for (const Eigen::MatrixXd* matrix : {&block.analytic, &block.numeric}) {
      for (Eigen::Index column = 0; column < matrix->cols(); ++column) {
        const double entry = (*matrix)(row, column);
        cells.emplace_back(Cell::fixed(std::abs(entry) < 5e-7 ? 0 : entry, 6));
      }
    }
    cells.emplace_back((block.analytic - block.numeric).row(row).cwiseAbs().maxCoeff());
    table.add_row(std::move(cells));
  }
}

}  // namespace

void add_inertial_jacobians(const RunData& run, Model& model) {
  if (!pipeline::tells_states(run)) return;
  const auto frame = frame_to_show(run);
  if (!frame) return;
  optimization::AuditOptions options;
  options.states = 1;
  options.min_residual = 0;  // a run's states agree with what was measured
  Table table(
      "inertial_jacobians", "Jacobian of the inertial factor, block by block",
      {"block", "row", "analytic: x", "y", "z", "numeric: x", "y", "z", "largest difference"});
  double largest = 0;
  std::size_t blocks = 0;
  for (const auto& kind : pipeline::factor_kinds_of_run(run, *frame)) {
    const auto shown =
        optimization::show_jacobians(kind, optimization::Perturbation::kRight, options);
    for (const optimization::ShownBlock& block : shown.blocks) {
      ++blocks;
      largest = std::max(largest, (block.analytic - block.numeric).cwiseAbs().maxCoeff());
      add_block(pipeline::book_name(shown.factor, block.block), block, table);
    }
  }
  model.add_text("inertial_jacobians_title",
                 fmt::format("The {} blocks of the inertial factor at frame {}, analytic beside "
                             "numeric: {:.1e} apart at most",
                             blocks, *frame, largest));
  model.add_text(
      "inertial_jacobians_how",
      fmt::format("Derivatives of the residual of rotation, velocity and position (dR, dv, dp) in "
                  "the state before (1) and after (2), each with its biases; rotations are moved "
                  "on the right. At the states of frame {} and the one before, between them a "
                  "constant rate and acceleration. At other frames: traverse check-jacobians "
                  "--show --run RUN --frame N.",
                  *frame));
  model.add_table(std::move(table));
}

}  // namespace traverse::report
