#include "figure_maker.hpp"

#include <memory>
#include <variant>

#include "traverse/files/atomic_file.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/render/vector_file.hpp"

namespace traverse::report {

FigureMaker::FigureMaker(const RunData& run,
                         const std::function<void(const std::string&)>& picture_drawn)
    : run_(run), picture_drawn_(picture_drawn), images_(pipeline::RunFolder{run.folder}.images()) {
  files::make_writable_folder(images_);
  dark_.theme = render::dark_theme();
}

FigureMaker::~FigureMaker() {
  writers_.cancel();
  try {
    writers_.wait();
  } catch (...) {  // NOLINT(bugprone-empty-catch): another error is already on its way
  }
}

render::Caption FigureMaker::caption(std::string title, std::string statistic) const {
  return {std::move(title), std::move(statistic), run_.recording_name(), run_.pipeline_name(),
          run_.date()};
}

std::size_t FigureMaker::begin(Figure figure) {
  const std::lock_guard lock(figures_mutex_);
  figures_.push_back(std::move(figure));
  return figures_.size() - 1;
}

void FigureMaker::finish(const render::Drawing& drawing, const std::string& file, std::size_t index,
                         bool dark) {
  // For paper: light, and only what is lines, for a million points are no drawing.
  if (!dark && render::is_vector(drawing)) {
    writers_.run([this, file, drawing] {
      files::write_text(images_ / (file + ".svg"), render::encode_svg(drawing));
      files::write_text(images_ / (file + ".pdf"), render::encode_pdf(drawing));
    });
  }
  const auto image = std::make_shared<const render::Image>(renderer_.render(drawing));
  writers_.run([this, file, index, dark, image] {
    std::string png = image->encode_png();
    files::write_text(images_ / (file + ".png"), png);
    const std::lock_guard lock(figures_mutex_);
    (dark ? figures_[index].dark_png : figures_[index].light_png) = std::move(png);
  });
}

std::vector<Figure> FigureMaker::take() {
  writers_.wait();
  return std::move(figures_);
}

}  // namespace traverse::report
