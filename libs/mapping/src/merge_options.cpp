#include "traverse/mapping/merge_runs.hpp"

namespace traverse::mapping {

void bind(config::Binder& b, MergeOptions& o) {
  using config::Range;
  b.integer("samples", o.samples, Range::between(1, 1e6),
            "keyframes of a run whose place is looked for");
  b.integer("candidates", o.candidates, Range::between(1, 100),
            "keyframes that look most alike, for each of them");
  b.number("search_m", o.search_m, Range::non_negative(), "registrations start so far around one");
  b.number("search_deg", o.search_deg, Range::between(0, 180), "and so far turned");
  b.number("min_overlap", o.min_overlap, Range::between(0, 1),
           "share of a keyframe's flat points on the other run's surfaces");
  b.number("max_residual_m", o.max_residual_m, Range::positive(), "rms of the matches");
  b.integer("min_agreeing", o.min_agreeing, Range::between(1, 1e6),
            "registrations that must place a run alike");
  b.number("agreement_m", o.agreement_m, Range::positive(), "how much alike");
  b.number("agreement_deg", o.agreement_deg, Range::positive(), "and in rotation");
  b.number("reach_m", o.reach_m, Range::positive(), "keyframes of two runs so near are registered");
  b.number("correction_m", o.correction_m, Range::positive(),
           "registrations farther from where the run was placed are not believed");
  b.integer("keyframes_around", o.keyframes_around, Range::between(0, 1000),
            "before and after one that make the surfaces it is registered on");
}

}  // namespace traverse::mapping
