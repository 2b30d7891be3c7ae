#include "plan/plan_metrics.hpp"

#include <algorithm>

#include "traverse/batch/metric.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"

#include "plan/plan_error.hpp"

namespace traverse::batch {

using config::Document;

void check_metric(const std::string& name, const config::Origin& origin) {
  if (find_metric(name) == nullptr) {
    throw plan_error(origin, "a metric (`traverse batch metrics` lists them)",
                     files::in_quotes(name));
  }
}

std::vector<std::string> read_metrics(const Document& document) {
  if (!document.has("metrics")) return default_metrics();
  std::vector<std::string> names;
  for (const Document& item : document.items("metrics", "name")) {
    const std::string name = item.scalar("name").value_or("");
    check_metric(name, item.origin());
    if (std::count(names.begin(), names.end(), name) > 0) {
      throw plan_error(item.origin(), "each metric once", files::in_quotes(name) + " again");
    }
    names.push_back(name);
  }
  if (names.empty()) throw plan_error(*document.origin("metrics"), "at least one metric", "none");
  return names;
}

std::vector<Budget> read_budgets(const Document& document) {
  std::vector<Budget> budgets;
  for (const config::Leaf& leaf : document.child("budgets").leaves()) {
    check_metric(leaf.path, leaf.origin);
    const auto most = files::parse_double(leaf.text);
    if (!most) throw plan_error(leaf.origin, "a number for '" + leaf.path + "'", leaf.text);
    budgets.push_back({leaf.path, *most});
  }
  return budgets;
}

}  // namespace traverse::batch
