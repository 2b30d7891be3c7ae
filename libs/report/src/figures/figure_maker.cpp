#include "figures/figure_maker.hpp"

#include <memory>
#include <stdexcept>
#include <utility>
#include <variant>

#include "traverse/files/atomic_file.hpp"
#include "traverse/render/vector_file.hpp"

#include "page/data_uri.hpp"

namespace traverse::report {

namespace {

render::Style of_width(render::Style style, int width) {
  style.height = style.height * width / style.width;
  style.width = width;
  return style;
}

}  // namespace

FigureMaker::FigureMaker(const RunData& run, const RunReportOptions& options,
                         std::filesystem::path images)
    : run_(run),
      picture_drawn_(options.picture_drawn),
      stop_(options.stop),
      images_(std::move(images)) {
  files::make_writable_folder(images_);
  light_ = of_width(light_, options.picture_width);
  dark_ = light_;
  dark_.theme = render::dark_theme();
  if (options.print_width) print_ = of_width(light_, *options.print_width);
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

render::Style FigureMaker::sized(render::Style style, double share) {
  style.width = static_cast<int>(share * style.width);
  style.height = static_cast<int>(share * style.height);
  return style;
}

std::size_t FigureMaker::begin(Figure figure) {
  if (stop_ != nullptr && *stop_) throw ReportStopped("the report was stopped by the user");
  if (!pipeline::RunFolder::is_picture(figure.name + ".png")) {
    // It would be taken for somebody's own file, which runs that come later leave there for ever.
    throw std::logic_error("no name of a run's pictures: " + figure.name);
  }
  const parallel::Lock lock(figures_mutex_);
  figures_.push_back(std::move(figure));
  return figures_.size() - 1;
}

void FigureMaker::finish(const render::Drawing& drawing, const std::string& file, std::size_t index,
                         bool dark) {
  // For paper: light, and only what is lines, for a million points are no drawing.
  const bool lines = render::is_vector(drawing);
  if (lines && !dark) {
    writers_.run([this, file, drawing] {
      files::write_text(images_ / (file + ".svg"), render::encode_svg(drawing));
      files::write_text(images_ / (file + ".pdf"), render::encode_pdf(drawing));
    });
  }
  const auto image = std::make_shared<const render::Image>(renderer_.render(drawing));
  writers_.run([this, file, index, dark, lines, image] {
    const std::string png = image->encode_png();
    files::write_text(images_ / (file + ".png"), png);
    // A page of many maps would be several times as large with them as PNG.
    std::string uri =
        lines ? data_uri("image/png", png) : data_uri("image/webp", image->encode_webp());
    const parallel::Lock lock(figures_mutex_);
    (dark ? figures_[index].dark : figures_[index].light) = std::move(uri);
  });
}

void FigureMaker::print(const render::Drawing& drawing, const std::string& file) {
  if (render::is_vector(drawing)) return;
  writers_.wait();  // one large picture at a time: it takes 126 MB at the largest
  const auto image = std::make_shared<const render::Image>(renderer_.render(drawing));
  writers_.run(
      [this, file, image] { files::write_text(images_ / (file + ".png"), image->encode_png()); });
}

std::vector<Figure> FigureMaker::take() {
  writers_.wait();
  const parallel::Lock lock(figures_mutex_);
  return std::move(figures_);
}

}  // namespace traverse::report
