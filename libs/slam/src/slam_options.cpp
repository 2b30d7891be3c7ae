#include "traverse/slam/slam.hpp"

namespace traverse::slam {

void bind(config::Binder& b, LoopChecks& o) {
  using config::Range;
  b.number(
      "min_overlap", o.min_overlap, Range::between(0, 1),
      "share of the keyframe's points on the submap's surfaces, to that of the submap's centre");
  b.number("max_residual_m", o.max_residual_m, Range::positive(), "rms of the matches");
  b.number("max_chi2", o.max_chi2, Range::positive(),
           "of the difference to odometry, 6 degrees of freedom");
  b.number("odometry_share", o.odometry_share, Range::non_negative(),
           "of the way, odometry's systematic part of that difference");
  b.number("confirmed_within_m", o.confirmed_within_m, Range::non_negative(),
           "a prediction this certain confirms a loop by itself");
  b.integer("witnesses_within", o.witnesses_within, Range::between(1, 10000),
            "keyframes before, else one of whose loops must agree");
  b.number("agreement_m", o.agreement_m, Range::positive(),
           "two loops and odometry close a circle up to this");
  b.number("agreement_deg", o.agreement_deg, Range::positive(), "and this");
  b.number("inflation", o.inflation, Range::positive(),
           "of the covariance from the solver's information");
  b.number("min_sigma_m", o.min_sigma_m, Range::positive(),
           "smallest standard deviation of a loop that is used");
  b.number("min_sigma_deg", o.min_sigma_deg, Range::positive(), "the same of its rotation");
}

void bind(config::Binder& b, SlamOptions& o) {
  using config::Range;
  b.group("keyframes", "scans that the map is made of",
          [&](config::Binder& g) { bind(g, o.keyframes); });
  b.number("memory_mb", o.memory_mb, Range::between(0, 1e7),
           "of keyframes; what is more goes to a temporary file");
  b.group("candidates", "earlier keyframes that may show the same place",
          [&](config::Binder& g) { bind(g, o.candidates); });
  b.group("submap", "surroundings of a candidate", [&](config::Binder& g) { bind(g, o.submap); });
  b.integer("submap_every", o.submap_every, Range::between(1, 1000),
            "submaps are centred at every n-th keyframe");
  b.group("registration", "of a keyframe in a submap",
          [&](config::Binder& g) { bind(g, o.registration); });
  b.group("loops", "what a loop must satisfy", [&](config::Binder& g) { bind(g, o.loops); });
  b.number("solve_at_chi2", o.solve_at_chi2, Range::non_negative(),
           "the graph is solved when an accepted loop is off by this");
  b.integer("solve_every", o.solve_every, Range::between(1, 1e6),
            "and after so many loops for each thousand keyframes");
  b.group("graph", "the pose graph", [&](config::Binder& g) { bind(g, o.graph); });
}

}  // namespace traverse::slam
