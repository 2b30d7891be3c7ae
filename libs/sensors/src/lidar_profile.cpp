#include "traverse/sensors/lidar_profile.hpp"

#include <array>

#include "traverse/config/document.hpp"

namespace traverse::sensors {

using config::Range;

namespace {

void bind(config::Binder& b, NoddingMirror& m) {
  b.number("turns_hz", m.turns_hz, Range::non_negative(), "turns a second; 0 if there is none");
  b.number("nods_hz", m.nods_hz, Range::non_negative(), "nods a second, down and up again");
  b.number("lowest_deg", m.lowest_deg, Range::between(-90, 90),
           "lowest elevation of the beams' middle");
  b.number("highest_deg", m.highest_deg, Range::between(-90, 90),
           "highest elevation of the beams' middle");
  b.numbers("tilts_deg", m.tilts_deg, "what each beam looks higher at the tilts' azimuth");
  b.number("tilt_azimuth_deg", m.tilt_azimuth_deg, Range::between(-360, 360),
           "azimuth at which they do, counterclockwise from ahead");
}

void bind(config::Binder& b, LidarFiring& f) {
  b.number("period_us", f.period_us, Range::non_negative(),
           "from one firing of all beams to the next; 0 if unknown");
  b.numbers("times_us", f.times_us,
            "time of each beam after the start of the firing, ring 0 first");
  b.numbers("azimuth_offsets_deg", f.azimuth_offsets_deg,
            "azimuth offset of each beam, counterclockwise, ring 0 first");
  b.group("mirror", "a mirror that turns many times in a sweep and nods, instead of a head",
          [&](config::Binder& group) { bind(group, f.mirror); });
}

void bind(config::Binder& b, LidarNoise& n) {
  b.number("range_m", n.range_m, Range::between(0, 1), "standard deviation of a range");
  b.number("resolution_m", n.resolution_m, Range::between(0, 1), "ranges are multiples of this");
  b.number("reach_at_10_percent_m", n.reach_at_10_percent_m, Range::positive(),
           "range of a surface of 10 % reflectivity");
  b.number("dropout_share", n.dropout_share, Range::between(0, 1),
           "share of returns that are lost");
  b.number("intensity_share", n.intensity_share, Range::between(0, 1),
           "standard deviation of an intensity, relative");
}

}  // namespace

void bind(config::Binder& b, LidarProfile& p) {
  static constexpr std::array<std::pair<std::string_view, RingSource>, 3> kRingSources{
      {{"data", RingSource::kData},
       {"storage_order", RingSource::kStorageOrder},
       {"elevation", RingSource::kElevation}}};
  static constexpr std::array<std::pair<std::string_view, TimeSource>, 3> kTimeSources{
      {{"data", TimeSource::kData},
       {"azimuth", TimeSource::kAzimuth},
       {"none", TimeSource::kNone}}};
  static constexpr std::array<std::pair<std::string_view, Rotation>, 2> kRotations{
      {{"clockwise", Rotation::kClockwise}, {"counterclockwise", Rotation::kCounterclockwise}}};

  b.text("name", p.name, "name of this sensor in reports");
  b.integer("rings", p.rings, Range::between(0, 1024), "number of beams; 0 if unknown");
  b.number("min_range_m", p.min_range_m, Range::non_negative(), "nearer points are dropped");
  b.number("max_range_m", p.max_range_m, Range::positive(), "farther points are dropped");
  b.number("intensity_full_scale", p.intensity_full_scale, Range::positive(),
           "stored intensity of the brightest return");
  b.choice("ring_source", p.ring_source, kRingSources, "where a point's ring number comes from");
  b.numbers("elevations_deg", p.elevations_deg, "elevation of each beam, ring 0 first");
  b.choice("time_source", p.time_source, kTimeSources, "where a point's time comes from");
  b.number("sweep_s", p.sweep_s, Range::positive(), "duration of one revolution");
  b.choice("rotation", p.rotation, kRotations, "turning direction of the head from above");
  b.number("seam_azimuth_deg", p.seam_azimuth_deg, Range::between(-360, 360),
           "azimuth at which a sweep begins and ends, counterclockwise from ahead");
  b.number("stamp_fraction", p.stamp_fraction, Range::between(0, 1),
           "share of the sweep that is over at the scan's stamp");
  b.number("vertical_correction_deg", p.vertical_correction_deg, Range::between(-5, 5),
           "added to the elevation of every point");
  b.number("pole_depth", p.pole_depth, Range::between(0, 1),
           "from the axis of a round pole to the mean of its returns, in radii");
  b.group("firing", "firing times and directions of the beams, for the simulator",
          [&](config::Binder& group) { bind(group, p.firing); });
  b.group("noise", "noise of the measurements, for the simulator",
          [&](config::Binder& group) { bind(group, p.noise); });
}

LidarProfile load_lidar_profile(const std::filesystem::path& yaml) {
  LidarProfile profile;
  config::read(config::Document::load(yaml), [&](config::Binder& b) { bind(b, profile); });
  return profile;
}

}  // namespace traverse::sensors
