#include "traverse/evaluation/ape.hpp"

#include "require_matched.hpp"

namespace traverse::evaluation {

Ape ape(const Poses& estimate, const Poses& reference, Relation relation) {
  require_matched(estimate, reference);
  Ape result;
  result.relation = relation;
  result.values.reserve(estimate.size());
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    result.values.push_back(absolute_error(estimate[i], reference[i], relation));
  }
  result.statistics = statistics_of(result.values);
  return result;
}

}  // namespace traverse::evaluation
