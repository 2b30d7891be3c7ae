#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/config/document.hpp"
#include "traverse/files/input_error.hpp"

#include "plan/plan_error.hpp"

/// What several entries of a plan have in common.
namespace traverse::batch {

/// The keys and values of the mapping under `key`: {"solver.huber_m=0.2"}.
inline std::vector<std::string> assignments_under(const config::Document& entry,
                                                  std::string_view key) {
  std::vector<std::string> assignments;
  for (const config::Leaf& leaf : entry.child(key).leaves()) {
    assignments.push_back(leaf.path + "=" + leaf.text);
  }
  return assignments;
}

/// The names under `key` ("pipelines") of recordings or pipelines of the plan, in the plan's order;
/// all of them where there is no such key. \param what one of them is called in messages
/// \throws files::InputError with file and line for a name that none of `all` has
template <typename Planned>
std::vector<std::string> read_names(const config::Document& entry, std::string_view key,
                                    const std::vector<Planned>& all, std::string_view what) {
  std::vector<std::string> chosen;
  for (const config::Document& item : entry.items(key, "name")) {
    const std::string name = item.scalar("name").value_or("");
    const bool is_there = std::any_of(all.begin(), all.end(),
                                      [&](const Planned& planned) { return planned.name == name; });
    if (!is_there) {
      throw plan_error(item.origin(), "the name of a " + std::string(what) + " of the plan",
                       files::in_quotes(name));
    }
    chosen.push_back(name);
  }
  std::vector<std::string> names;
  for (const Planned& planned : all) {
    const bool is_chosen =
        !entry.has(key) || std::find(chosen.begin(), chosen.end(), planned.name) != chosen.end();
    if (is_chosen) names.push_back(planned.name);
  }
  return names;
}

}  // namespace traverse::batch
