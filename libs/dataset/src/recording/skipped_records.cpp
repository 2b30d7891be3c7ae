#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

void SkippedRecords::add(const std::string& reason, const std::string& place) {
  constexpr std::size_t kPlacesKept = 10;
  Count& count = by_reason_[reason];
  ++count.count;
  if (count.first_places.size() < kPlacesKept) count.first_places.push_back(place);
}

std::size_t SkippedRecords::total() const {
  std::size_t sum = 0;
  for (const auto& [reason, count] : by_reason_) sum += count.count;
  return sum;
}

}  // namespace traverse::dataset
