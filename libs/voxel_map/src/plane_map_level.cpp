#include "traverse/voxel_map/plane_map.hpp"

namespace traverse::voxel_map {

std::uint32_t PlaneMap::Level::find_or_add(const CellNumber& number) {
  const auto next = static_cast<std::uint32_t>(cold.size());
  const std::uint32_t index = table.find_or_add(cell_key(number.x, number.y, number.z), next);
  if (index == next) {
    cold.emplace_back();
    planes.emplace_back();
    numbers.push_back(number);
  }
  return index;
}

void PlaneMap::Level::move(std::size_t from, std::size_t to) {
  cold[to] = cold[from];
  planes[to] = planes[from];
  numbers[to] = numbers[from];
}

void PlaneMap::Level::keep_first(std::size_t cells) {
  cold.resize(cells);
  planes.resize(cells);
  numbers.resize(cells);
  table.clear(cells);
  for (std::uint32_t k = 0; k < cells; ++k) {
    table.find_or_add(cell_key(numbers[k].x, numbers[k].y, numbers[k].z), k);
  }
}

std::size_t PlaneMap::Level::bytes() const {
  return table.bytes() + cold.capacity() * sizeof(ColdCell) +
         planes.capacity() * sizeof(PlaneCell) + numbers.capacity() * sizeof(CellNumber);
}

}  // namespace traverse::voxel_map
