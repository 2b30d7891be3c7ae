#pragma once

namespace traverse::sensors {

/// What an encoder's pulses mean, one wheel on each side.
struct WheelEncoder {
  double left_m_per_pulse = 0;  ///< distance along the ground; 0 where it is not known
  double right_m_per_pulse = 0;
};

}  // namespace traverse::sensors
