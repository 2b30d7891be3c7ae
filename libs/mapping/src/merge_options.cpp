#include "traverse/mapping/merge_runs.hpp"

namespace traverse::mapping {

void bind(config::Binder& b, MergeOptions& o) {
  using config::Range;
  b.integer("samples", o.samples, Range::between(1, 1e6),
            "keyframes of a run that are searched for in the other");
  b.integer("candidates", o.candidates, Range::between(1, 100),
            "most similar keyframes that are tried, for each");
  b.number("search_m", o.search_m, Range::non_negative(),
           "radius of the search around a candidate");
  b.number("search_deg", o.search_deg, Range::between(0, 180),
           "half width of its search in heading");
  b.number("min_overlap", o.min_overlap, Range::between(0, 1),
           "share of a keyframe's flat points on the other run's surfaces");
  b.number("max_residual_m", o.max_residual_m, Range::positive(), "rms of the matches");
  b.integer("min_agreeing", o.min_agreeing, Range::between(1, 1e6),
            "registrations that must agree on the position of a run");
  b.number("agreement_m", o.agreement_m, Range::positive(),
           "agreement of two registrations in position");
  b.number("agreement_deg", o.agreement_deg, Range::positive(),
           "agreement of two registrations in rotation");
  b.number("reach_m", o.reach_m, Range::positive(),
           "largest distance between keyframes of two runs that are registered");
  b.number("correction_m", o.correction_m, Range::positive(),
           "registrations that move a keyframe farther than this are rejected");
  b.integer("keyframes_around", o.keyframes_around, Range::between(0, 1000),
            "keyframes before and after one that form its submap");
}

}  // namespace traverse::mapping
