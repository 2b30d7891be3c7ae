#include "traverse/pose_graph/graph_options.hpp"

namespace traverse::pose_graph {

void bind(config::Binder& b, GraphOptions& o) {
  using config::Range;
  b.flag("robust", o.robust,
         "robust weights: loops, fixes and gravity directions that contradict the rest lose their "
         "weight");
  b.number("outlier_probability", o.outlier_probability, Range::between(1e-6, 0.5),
           "probability that a consistent loop is taken for a false one: where its weight begins "
           "to fall");
  b.number("graduation", o.graduation, Range::between(1.4, 100),
           "factor by which that bound shrinks per stage, from the largest residual on");
  b.integer("steps_a_stage", o.steps_a_stage, Range::between(1, 100),
            "Levenberg-Marquardt steps per stage");
  b.integer("max_iterations", o.max_iterations, Range::between(1, 1000),
            "Levenberg-Marquardt steps of the last stage");
  b.number("min_fix_spread", o.min_fix_spread, Range::between(1, 1e6),
           "GNSS fixes orient the map when their spread exceeds this number of their standard "
           "deviations");
  b.number("up_offset_deg", o.up_offset_deg, Range::non_negative(),
           "standard deviation of the error that all measured directions of gravity share");
}

}  // namespace traverse::pose_graph
