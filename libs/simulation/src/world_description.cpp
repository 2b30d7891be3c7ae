#include "traverse/simulation/world_description.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/config/document.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::simulation {

using config::Range;
using files::InputError;
using FilePlace = files::Place;

namespace {

namespace fs = std::filesystem;

void bind(config::Binder& b, ClockSettings& s) {
  b.number("imu_late_s", s.imu_late_s, Range::between(-1, 1), "of the IMU's stamps");
  b.number("wheels_late_s", s.wheels_late_s, Range::between(-1, 1), "of the wheels' stamps");
  b.number("gnss_late_s", s.gnss_late_s, Range::between(-1, 1), "of the receiver's stamps");
}

/// The error about the value of `key`, which stands in the document or is a default.
InputError error_at(const config::Document& document, const fs::path& file, const std::string& key,
                    const std::string& expected, const std::string& found) {
  const auto origin = document.origin(key);
  const std::string what = expected + " for '" + key + "'";
  if (!origin) return {file, FilePlace::key(key), what, found};
  return {origin->source, origin->line > 0 ? FilePlace::line(origin->line) : FilePlace{}, what,
          found};
}

void check(const WorldDescription& world, const config::Document& document, const fs::path& file) {
  try {
    const Route route(world.route);
  } catch (const ImpossibleRoute& error) {
    throw error_at(document, file, "route." + error.key, error.expected, error.found);
  }
  const auto& outages = world.gnss.outages_s;
  if (outages.size() % 2 != 0 || !std::is_sorted(outages.begin(), outages.end())) {
    throw error_at(document, file, "gnss.outages_s", "from and to by turns, ascending",
                   fmt::format("{}", outages));
  }
}

}  // namespace

void bind(config::Binder& b, WorldDescription& w) {
  const auto group = [&](const char* key, const char* meaning, auto& settings) {
    b.group(key, meaning, [&](config::Binder& g) { bind(g, settings); });
  };
  b.text("name", w.name, "for titles");
  b.text("description", w.description, "one line about the world");
  b.text("sensor", w.sensor, "the lidar, if the command line names none");
  b.integer("seed", w.seed, Range::between(0, 1e15), "of the place, the road and all noise");
  b.integer("drive_seed", w.drive_seed, Range::between(-1, 1e15),
            "of another drive through it: noise, traffic, parked cars, line, pace; -1: its own");
  b.number("start_s", w.start_s, Range::between(0, 4e9), "Unix time of the drive's start");
  group("route", "where the vehicle goes and how fast", w.route);
  group("terrain", "the shape of the ground", w.terrain);
  group("place", "what is built along the route", w.place);
  group("suspension", "how the body moves on its wheels", w.suspension);
  group("gait", "how a person carries it, in place of wheels", w.gait);
  group("lidar", "where the lidar sits", w.lidar);
  group("imu", "the inertial measurement unit", w.imu);
  group("wheels", "the wheels' pulse counters", w.wheels);
  group("gnss", "the satellite receiver", w.gnss);
  group("clock", "by how much stamps are late", w.clock);
}

std::optional<std::uint64_t> other_drive(const WorldDescription& world) {
  if (world.drive_seed < 0 || world.drive_seed == world.seed) return std::nullopt;
  return static_cast<std::uint64_t>(world.drive_seed);
}

WorldDescription load_world(const fs::path& file, const std::vector<std::string>& overrides) {
  config::Document document = config::Document::load(file);
  for (const std::string& assignment : overrides) document.set(assignment);
  WorldDescription world;
  config::read(document, [&](config::Binder& b) { bind(b, world); });
  check(world, document, file);
  return world;
}

fs::path find_world(const std::string& name, const fs::path& share) {
  if (name.find('/') != std::string::npos || name.ends_with(".yaml")) return name;
  const fs::path folder = share / "worlds";
  const fs::path file = folder / (name + ".yaml");
  if (fs::exists(file)) return file;
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  throw InputError(folder, FilePlace::whole_file(),
                   fmt::format("a world ({})", fmt::join(names, ", ")), files::in_quotes(name));
}

}  // namespace traverse::simulation
