#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// Adds a fact that is not told yet, as when a recording is read once more.
inline void note_once(Fact fact, std::vector<Fact>& facts) {
  const bool is_told = std::any_of(facts.begin(), facts.end(), [&](const Fact& told) {
    return told.name == fact.name && told.value == fact.value;
  });
  if (!is_told) facts.push_back(std::move(fact));
}

}  // namespace traverse::dataset
