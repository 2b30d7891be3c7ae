#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tbb/task_group.h>

#include "traverse/parallel/mutex.hpp"
#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/renderer.hpp"
#include "traverse/render/style.hpp"

#include "figures/figures.hpp"

namespace traverse::report {

/// Draws one picture after another with one renderer; while the next is drawn, the ones before are
/// compressed and written by other threads.
class FigureMaker {
 public:
  /// \param images folder for the pictures
  FigureMaker(const RunData& run, const RunReportOptions& options, std::filesystem::path images);
  ~FigureMaker();
  FigureMaker(const FigureMaker&) = delete;
  FigureMaker& operator=(const FigureMaker&) = delete;

  render::Caption caption(std::string title, std::string statistic) const;

  /// `draw` makes the drawing for a style; `text` stands below the picture on the page; see
  /// Figure::replaced_by.
  template <typename Draw>
  void add(const std::string& section, const std::string& name, const std::string& text,
           const Draw& draw, const std::string& replaced_by = {}) {
    add_sized(section, name, text, draw, replaced_by, 1);
  }

  /// The same in a part of the usual size.
  template <typename Draw>
  void add_sized(const std::string& section, const std::string& name, const std::string& text,
                 const Draw& draw, const std::string& replaced_by, double share) {
    const std::size_t index = begin({name, section, text, replaced_by, {}, {}});
    finish(draw(sized(light_, share)), name, index, false);
    finish(draw(sized(dark_, share)), name + "_dark", index, true);
    if (print_) print(draw(*print_), name + "_print");
    picture_drawn_(name);
  }

  /// Waits for all of them. \throws files::OutputError if one could not be written.
  std::vector<Figure> take();

 private:
  static render::Style sized(render::Style style, double share);
  /// \throws ReportStopped
  std::size_t begin(Figure figure);
  void finish(const render::Drawing& drawing, const std::string& file, std::size_t index,
              bool dark);

  /// Lines have their SVG and PDF for paper: only point clouds are written.
  void print(const render::Drawing& drawing, const std::string& file);

  const RunData& run_;
  std::function<void(const std::string&)> picture_drawn_;
  const std::atomic<bool>* stop_;
  std::filesystem::path images_;
  render::Renderer renderer_;
  render::Style light_;
  render::Style dark_;
  std::optional<render::Style> print_;  ///< large, for paper
  parallel::Mutex figures_mutex_;
  std::vector<Figure> figures_ TRAVERSE_GUARDED_BY(figures_mutex_);  ///< grows while others fill
  tbb::task_group writers_;
};

}  // namespace traverse::report
