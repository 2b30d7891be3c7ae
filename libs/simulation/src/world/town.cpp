#include <cmath>
#include <numbers>

#include "furniture.hpp"
#include "house.hpp"
#include "plants.hpp"
#include "scatter.hpp"
#include "site.hpp"

namespace traverse::simulation {

namespace {

constexpr double kTownKerb = 0.12;
constexpr double kSideStreet = 3.2;  ///< metres, half width

/// Streets that leave the main one: straight on at its corners, and across the middle of long legs.
std::vector<Street> side_streets(Site& site, const Street& street) {
  std::vector<Street> result;
  const auto turns = [&](double s) {
    return std::abs(std::remainder(street.at(s + 6).heading - street.at(s - 6).heading,
                                   2 * std::numbers::pi)) > 0.05;
  };
  double leg_begin = 0;
  for (double s = 8; s < street.length_m() - 8; s += 1) {
    const bool ends_leg = turns(s) && !turns(s - 1);
    if (ends_leg) {
      const Street::Station end = street.at(s - 6);
      result.push_back(straight_street(end.point, end.beside(0) + 75 * end.ahead()));
      const double leg = s - leg_begin;
      if (leg > 80) {
        const Street::Station middle = street.at(leg_begin + leg * site.random.uniform(0.42, 0.58));
        result.push_back(straight_street(middle.point, middle.beside(-70)));
      }
    }
    if (turns(s)) leg_begin = s;
  }
  return result;
}

/// Houses of one kind, wall to wall: places that only furniture and corners tell apart.
void add_terrace(Site& site, const Street& street, double half_width, double side) {
  const HousePlan plan;
  Random alike(1);
  const Mesh house = make_house(plan, alike);
  const double front = half_width + site.settings.pavement_m + 0.15;
  const Eigen::Vector2d size(plan.width, plan.depth);
  for (double s = 2; s < street.length_m() - 4;) {
    const Street::Station middle = street.at(s + plan.width / 2);
    const Eigen::Vector2d centre = middle.beside(side * (front + plan.depth / 2));
    if (!site.plan.is_free(centre, middle.heading, size)) {
      s += 3;
      continue;
    }
    site.plan.take(centre, middle.heading, size);
    const double yaw = middle.heading + (side > 0 ? 0 : std::numbers::pi);
    site.mesh.add(house, upright(site.on_ground(middle.beside(side * front), kTownKerb), yaw));
    s += plan.width + 0.01;
  }
}

/// Houses in a row, now and then with a gap closed by a hedge.
void add_houses(Site& site, const Street& street, double half_width, double side) {
  Random& random = site.random;
  const double front = half_width + site.settings.pavement_m;
  for (double s = 2; s < street.length_m() - 4;) {
    HousePlan plan;
    plan.width = random.uniform(8, 17);
    plan.depth = random.uniform(8, 12);
    plan.floors = 2 + static_cast<int>(random.below(3));
    plan.gabled = plan.floors < 4 && random.chance(0.7);
    const double setback = random.chance(0.5) ? 0.15 : random.uniform(1.5, 5);
    const Street::Station middle = street.at(s + plan.width / 2);
    const Eigen::Vector2d centre = middle.beside(side * (front + setback + plan.depth / 2));
    const Eigen::Vector2d size(plan.width, plan.depth);
    if (!site.plan.is_free(centre, middle.heading, size)) {
      s += 3;
      continue;
    }
    site.plan.take(centre, middle.heading, size + Eigen::Vector2d(0.3, 1));
    const double yaw = middle.heading + (side > 0 ? 0 : std::numbers::pi);
    const Eigen::Vector2d door = middle.beside(side * (front + setback));
    site.mesh.add(make_house(plan, random), upright(site.on_ground(door, kTownKerb), yaw));
    s += plan.width;
    if (!random.chance(0.35)) continue;
    const double gap = random.uniform(3, 8);
    const Street::Station at = street.at(s + gap / 2);
    const Eigen::Vector2d p = at.beside(side * (front + 0.6));
    if (site.plan.is_free(p, at.heading, {gap, 1})) {
      site.plan.take(p, at.heading, {gap, 1});
      site.mesh.add(make_hedge(gap, random.uniform(1, 1.8), random),
                    upright(site.on_ground(p, kTownKerb), at.heading));
    }
    s += gap;
  }
}

/// A car where one stood when the place was built. On another day it is there still, or has left,
/// or another one stands in its stead.
void park(Site& site, const Mesh& car, const Assortment& cars, geometry::Pose3 T_map_car) {
  const double dice = site.other_day ? site.other_day->uniform(0, 1) : 0;
  if (dice > 0.75) return;
  if (dice > 0.5) {
    T_map_car.translation += T_map_car.rotation.col(0) * site.other_day->uniform(-0.5, 0.5);
    site.mesh.add(cars.pick(*site.other_day), T_map_car);
    return;
  }
  site.mesh.add(car, T_map_car);
}

/// Things along the kerb: trees and lamp posts on the pavement, parked cars on the road.
void line_kerb(Site& site, const Street& street, unsigned number, double half_width, double side,
               const Greenery& greenery, const Assortment& cars) {
  Random& random = site.random;
  const double density = site.settings.density;
  if (density == 0) return;
  const auto is_crossing = [&](double s, double lateral) {
    return site.plan.is_other_road(street.at(s).beside(lateral), number) ||
           site.plan.is_other_road(street.at(s - 3).beside(lateral), number) ||
           site.plan.is_other_road(street.at(s + 3).beside(lateral), number);
  };
  const double on_pavement = side * (half_width + 0.55);
  const Mesh lamp = make_lamp_post(6.5);
  double next_lamp = random.uniform(5, 20);
  for (double s = 4; s < street.length_m() - 4; s += random.uniform(6, 14) / density) {
    if (is_crossing(s, on_pavement)) continue;
    const Street::Station at = street.at(s);
    const Eigen::Vector2d p = at.beside(on_pavement);
    if (s > next_lamp) {
      const double yaw = at.heading + (side > 0 ? std::numbers::pi : 0);
      site.mesh.add(lamp, upright(site.on_ground(p, kTownKerb), yaw));
      next_lamp = s + 25;
    } else if (random.chance(0.55)) {
      plant(site, greenery.trees, p, 0.4, kTownKerb, 0.7, 1.1);
    } else if (random.chance(0.5)) {
      site.mesh.add(random.chance(0.6) ? make_sign(random) : make_bin(),
                    upright(site.on_ground(p, kTownKerb), at.heading));
    }
  }
  for (double s = 6; s < street.length_m() - 6; s += random.uniform(5.6, 13) / density) {
    const double lateral = side * (half_width - 1.05 + random.uniform(-0.1, 0.1));
    if (is_crossing(s - 3, lateral) || is_crossing(s + 3, lateral)) continue;
    const double yaw =
        street.at(s).heading + random.uniform(-0.03, 0.03) + (side > 0 ? std::numbers::pi : 0);
    park(site, cars.pick(random), cars, upright(site.on_ground(street.at(s).beside(lateral)), yaw));
  }
}

/// Gardens: what lies behind the houses.
void add_gardens(Site& site, const Greenery& greenery) {
  const Eigen::Vector2d size = site.plan.most() - site.plan.least();
  const auto count = static_cast<int>(site.settings.density * size.x() * size.y() / 160);
  for (int i = 0; i < count; ++i) {
    const double north = site.random.uniform(0, 1);
    const double east = site.random.uniform(0, 1);
    const Eigen::Vector2d p = site.plan.least() + size.cwiseProduct(Eigen::Vector2d(east, north));
    const double dice = site.random.uniform(0, 1);
    if (dice < 0.3) plant(site, greenery.trees, p, 5, kTownKerb);
    if (dice > 0.3 && dice < 0.4) plant(site, greenery.conifers, p, 4, kTownKerb);
    if (dice > 0.4) plant(site, greenery.bushes, p, 1.5, kTownKerb);
  }
}

void add_lane_marks(Site& site, const Street& street, unsigned number) {
  for (double s = 3; s + 3 < street.length_m(); s += 6) {
    if (site.plan.is_other_road(street.at(s).point, number)) continue;
    sweep(site.mesh, street.part(s, s + 3), site.terrain, {0.06, 0.004}, {-0.06, 0.004},
          Material::kMarking);
  }
}

}  // namespace

void build_town(Site& site) {
  const double half_width = site.settings.half_width_m;
  std::vector<Street> streets{site.main_street()};
  for (Street& street : side_streets(site, streets.front())) streets.push_back(std::move(street));
  const auto width = [&](std::size_t i) { return i == 0 ? half_width : kSideStreet; };
  for (std::size_t i = 0; i < streets.size(); ++i) {
    site.plan.add_road(streets[i], width(i), static_cast<unsigned>(i % 32));
  }
  build_ground(site, Material::kGrass, 1, kTownKerb - 0.03);

  const Greenery greenery(site.random);
  const Assortment cars(10, [&](std::size_t) { return make_car(site.random); });
  for (std::size_t i = 0; i < streets.size(); ++i) {
    const auto number = static_cast<unsigned>(i % 32);
    build_street(site, streets[i], number, width(i));
    add_lane_marks(site, streets[i], number);
    const auto& build = site.settings.terraced ? add_terrace : add_houses;
    for (const double side : {-1.0, 1.0}) build(site, streets[i], width(i), side);
    for (const double side : {-1.0, 1.0}) {
      // Beside the narrow streets cars park on one side only.
      if (i > 0 && side > 0) continue;
      line_kerb(site, streets[i], number, width(i), side, greenery, cars);
    }
  }
  add_gardens(site, greenery);
}

}  // namespace traverse::simulation
