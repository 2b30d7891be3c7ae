#include "traverse/voxel_map/sweep_sampler.hpp"

#include <algorithm>

#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::voxel_map {

SweepSampler::SweepSampler(const SamplingOptions& options, const sensors::LidarProfile& profile,
                           bool deskews)
    : options_(options), profile_(profile), deskews_(deskews), sweeps_(profile) {}

SweepSample SweepSampler::sample(const sensors::LidarScan& scan, parallel::Workers& workers) {
  SweepSample sample = sample_sweep(scan, profile_, options_, workers);
  if (!deskews_) return sample;
  if (profile_.time_source == sensors::TimeSource::kAzimuth) {
    count_times_from((0.5 - profile_.stamp_fraction) * profile_.sweep_s, sample);
    return sample;
  }
  const auto [first_s, last_s] = time_span(sample);
  if (sweeps_.lacks_times(first_s, last_s)) {
    for (SweepPoints* points : {&sample.surface, &sample.planar, &sample.edges}) {
      std::fill(points->time.begin(), points->time.end(), 0.0F);
    }
    sample.middle_s = sweeps_.usual_middle_s();
    sweeps_.learn(scan.stamp, 0, 0);
  } else {
    count_times_from(0.5 * (first_s + last_s), sample);
    sweeps_.learn(scan.stamp, first_s, last_s);
  }
  return sample;
}

double SweepSampler::interval(geometry::Stamp earlier, double earlier_middle_s,
                              const SweepSample& later) const {
  const double stamped = sweeps_.interval(earlier, later.stamp);
  const double seconds = stamped > 0 ? stamped + later.middle_s - earlier_middle_s : stamped;
  return seconds > 0 ? seconds : profile_.sweep_s;
}

}  // namespace traverse::voxel_map
