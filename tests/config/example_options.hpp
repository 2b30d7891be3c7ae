#pragma once

#include <array>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"

namespace traverse::config {

enum class Form { kVector, kScalar };

struct ExampleOptions {
  double threshold = 0.5;
  int count = 3;
  bool deskew = true;
  std::string label = "a";
  std::vector<double> angles{1, 2};
  Form form = Form::kVector;
  double inner_gate_m = 1;
};

inline void bind(Binder& b, ExampleOptions& o) {
  static constexpr std::array<std::pair<std::string_view, Form>, 2> kForms{
      {{"vector", Form::kVector}, {"scalar", Form::kScalar}}};
  b.number("threshold", o.threshold, Range::between(0, 1), "share");
  b.integer("count", o.count, Range::non_negative(), "how many");
  b.flag("deskew", o.deskew, "undo motion");
  b.text("label", o.label, "a name");
  b.numbers("angles", o.angles, "degrees");
  b.choice("form", o.form, kForms, "of the residual");
  b.group("inner", "a group", [&](Binder& inner) {
    inner.number("gate_m", o.inner_gate_m, Range::positive(), "gate");
  });
}

inline Bind binding(ExampleOptions& options) {
  return [&options](Binder& b) { bind(b, options); };
}

}  // namespace traverse::config
