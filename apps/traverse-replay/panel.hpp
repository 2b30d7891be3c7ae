#pragma once

#include "chart.hpp"
#include "console.hpp"
#include "estimator_group.hpp"
#include "health_group.hpp"
#include "view_group.hpp"
#include "window_frame.hpp"

namespace traverse::app {

/// The column at the right: what is shown and how, how the frame went, which estimator is at work.
class Panel : public WindowFrame {
 public:
  static constexpr int kWidth = 300;

  Panel(nanogui::Widget* parent, Console& console);

  /// Folds what tells least until the rest fits.
  void fold_to_fit(int height);

  /// At most ten times a second, so that numbers can be read.
  void refresh(const replay::ColourLegend& legend);

 private:
  void refresh_charts();

  Console& console_;
  ViewGroup* view_;
  HealthGroup* health_;
  FoldingGroup* charts_;
  EstimatorGroup* estimator_;
  Chart* error_;
  Chart* time_;
  std::vector<float> errors_;
  std::vector<float> milliseconds_;
  unsigned generation_ = 0;
};

}  // namespace traverse::app
