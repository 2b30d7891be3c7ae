#include "sample_streams.hpp"

#include <algorithm>
#include <utility>

namespace traverse::simulation {

void SampleStreams::add(double rate_hz, double late_s, Sample sample) {
  streams_.push_back({rate_hz, late_s, std::move(sample)});
}

void SampleStreams::give_until(double seconds,
                               const std::function<void(sensors::Measurement&&)>& use) {
  while (!streams_.empty()) {
    Stream& first =
        *std::min_element(streams_.begin(), streams_.end(),
                          [](const Stream& a, const Stream& b) { return a.next_s() < b.next_s(); });
    if (first.next_s() >= seconds) return;
    if (auto measurement = first.sample(first.next++)) use(std::move(*measurement));
  }
}

}  // namespace traverse::simulation
