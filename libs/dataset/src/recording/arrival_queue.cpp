#include "recording/arrival_queue.hpp"

#include <utility>

#include "recording/note_once.hpp"

namespace traverse::dataset {

void ArrivalQueue::push(sensors::Measurement measurement, const std::string& place) {
  if (clock_ == Clock::kSteady) {
    window_.push({std::move(measurement), place});
    return;
  }
  watch_.push({std::move(measurement), place});
  take_decided();
}

void ArrivalQueue::finish() {
  watch_.finish();
  take_decided();
  is_finished_ = true;
}

void ArrivalQueue::drop_waiting() {
  while (window_.pop(true)) {
  }
}

void ArrivalQueue::note_steps(std::vector<Fact>& facts) {
  for (Fact& step : watch_.take_steps()) note_once(std::move(step), facts);
}

void ArrivalQueue::take_decided() {
  for (auto& rejected : watch_.take_rejected()) skipped_.add(rejected.fault, rejected.place);
  for (auto& entry : watch_.take_accepted()) window_.push(std::move(entry));
}

std::optional<sensors::Measurement> ArrivalQueue::pop() {
  while (auto entry = window_.pop(is_finished_)) {
    if (order_.accept(entry->measurement)) return std::move(entry->measurement);
    skipped_.add(StampOrder::kFault, entry->place);
  }
  return std::nullopt;
}

}  // namespace traverse::dataset
