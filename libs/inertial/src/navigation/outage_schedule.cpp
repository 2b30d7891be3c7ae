#include "navigation/outage_schedule.hpp"

namespace traverse::inertial {

void OutageSchedule::start(geometry::Stamp stamp) {
  begin_ = geometry::shifted(stamp, options_.first_s);
}

bool OutageSchedule::is_out(geometry::Stamp stamp) {
  ended_ = false;
  if (!begin_ || next_ == options_.spells_s.size() || stamp < *begin_) return false;
  if (geometry::seconds_between(*begin_, stamp) < options_.spells_s[next_]) {
    if (!is_out_) distance_m_ = 0;
    is_out_ = true;
    return true;
  }
  // Over, or the recording has a hole where it was.
  ended_ = is_out_;
  is_out_ = false;
  if (!ended_) {
    ++next_;
    begin_ = geometry::shifted(stamp, options_.between_s);
  }
  return false;
}

OutageResult OutageSchedule::take_result(double error_m, double sigma_m) {
  const OutageResult result{options_.spells_s[next_], distance_m_, error_m, sigma_m};
  begin_ = geometry::shifted(geometry::shifted(*begin_, result.seconds), options_.between_s);
  ++next_;
  ended_ = false;
  return result;
}

}  // namespace traverse::inertial
