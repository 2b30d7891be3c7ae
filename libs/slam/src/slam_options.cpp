#include "traverse/slam/slam.hpp"

namespace traverse::slam {

void bind(config::Binder& b, LoopChecks& o) {
  using config::Range;
  b.number(
      "min_overlap", o.min_overlap, Range::between(0, 1),
      "share of the keyframe's points on the submap's surfaces, to that of the submap's centre");
  b.number("max_residual_m", o.max_residual_m, Range::positive(), "rms of the matches");
  b.number("max_chi2", o.max_chi2, Range::positive(),
           "chi-square of the difference to odometry, 6 degrees of freedom");
  b.number("odometry_share", o.odometry_share, Range::non_negative(),
           "systematic error of odometry, share of the path length");
  b.number("confirmed_within_m", o.confirmed_within_m, Range::non_negative(),
           "standard deviation of a prediction that confirms a loop by itself");
  b.integer("witnesses_within", o.witnesses_within, Range::between(1, 10000),
            "earlier keyframes, one of whose loops must agree otherwise");
  b.number("agreement_m", o.agreement_m, Range::positive(),
           "error of the circle of two loops and odometry, position");
  b.number("agreement_deg", o.agreement_deg, Range::positive(), "agreement in rotation");
  b.number("inflation", o.inflation, Range::positive(),
           "factor on the covariance from the solver's information");
  b.number("min_sigma_m", o.min_sigma_m, Range::positive(),
           "smallest standard deviation of a loop that is used");
  b.number("min_sigma_deg", o.min_sigma_deg, Range::positive(), "the same of its rotation");
}

void bind(config::Binder& b, SlamOptions& o) {
  using config::Range;
  b.group("keyframes", "scans of which the map is made",
          [&](config::Binder& g) { bind(g, o.keyframes); });
  b.number("memory_mb", o.memory_mb, Range::between(0, 1e7),
           "memory of keyframes; the rest goes to a temporary file");
  b.group("candidates", "earlier keyframes that may show the same place",
          [&](config::Binder& g) { bind(g, o.candidates); });
  b.group("submap", "surroundings of a candidate", [&](config::Binder& g) { bind(g, o.submap); });
  b.integer("submap_every", o.submap_every, Range::between(1, 1000),
            "submaps are centred at every n-th keyframe");
  b.group("registration", "registration of a keyframe in a submap",
          [&](config::Binder& g) { bind(g, o.registration); });
  b.group("loops", "acceptance of loops", [&](config::Binder& g) { bind(g, o.loops); });
  b.number("solve_at_chi2", o.solve_at_chi2, Range::non_negative(),
           "chi-square of an accepted loop at which the graph is solved");
  b.integer("solve_every", o.solve_every, Range::between(1, 1e6),
            "loops per thousand keyframes after which the graph is solved");
  b.group("graph", "the pose graph", [&](config::Binder& g) { bind(g, o.graph); });
}

}  // namespace traverse::slam
