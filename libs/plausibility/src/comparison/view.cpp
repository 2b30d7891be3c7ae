#include "comparison/view.hpp"

namespace traverse::plausibility {

View::View(const Evidence& all) : evidence(all) {
  for (const auto& [label, track] : all.receivers) {
    JudgedReceiver& receiver = receivers[label];
    receiver.delay = find_receiver_delay(all, label, legs_of(track, PlaceReading::kAsRead, 0));
    const double delay_s = receiver.delay ? receiver.delay->delay.seconds : 0;
    receiver.judgement = judge_places(all, track, delay_s);
    receiver.stamped = legs_of(track, receiver.judgement.reading, 0);
    receiver.legs = legs_of(track, receiver.judgement.reading, delay_s);
  }
}

}  // namespace traverse::plausibility
