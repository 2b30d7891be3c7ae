#include "comparison/view.hpp"

namespace traverse::plausibility {

View::View(const Evidence& all) : evidence(all) {
  for (const auto& [label, track] : all.receivers) {
    const PlaceJudgement judgement = judge_places(all, track);
    receivers[label] = {judgement, legs_of(track, judgement.reading)};
  }
}

}  // namespace traverse::plausibility
