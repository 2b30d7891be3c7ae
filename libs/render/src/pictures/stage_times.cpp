#include "traverse/render/pictures/stage_times.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/note.hpp"
#include "plot/number_text.hpp"
#include "plot/plot_area.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kBarShare = 0.5;     // of a row's height
constexpr double kHighestRow = 6;     // in body text sizes
constexpr double kNamesShare = 0.35;  // of the width, at most

struct Row {
  StageTime time;
  Colour colour;
};

/// The two columns of numbers at the right, all with the same decimals.
struct Columns {
  double median_right = 0;
  double p95_right = 0;
  int decimals = 0;
};

double widest_name(const Canvas& canvas, const std::vector<Row>& rows) {
  double width = 0;
  for (const Row& row : rows) {
    width = std::max(width, canvas.width_of(row.time.name, canvas.sizes().body));
  }
  return width;
}

void draw_numbers(Canvas& canvas, const Columns& columns, const std::string& median,
                  const std::string& p95, double baseline) {
  canvas.text(canvas.body(median, {columns.median_right, baseline}, HorizontalAlign::kRight));
  canvas.text(coloured(canvas.body(p95, {columns.p95_right, baseline}, HorizontalAlign::kRight),
                       canvas.theme().muted));
}

void draw_bar(Canvas& canvas, const PlotArea& area, const Row& row, double middle, double height) {
  const Colour ink = canvas.theme().text;
  const double line = 0.7 * canvas.sizes().line;
  const double median = area.x_at(row.time.median_ms);
  const double p95 = area.x_at(row.time.p95_ms);
  if (std::isfinite(median)) {
    canvas.fill({area.rect.left, middle - height / 2, median, middle + height / 2}, row.colour);
  }
  if (std::isfinite(p95) && p95 > median) {
    canvas.straight({median, middle}, {p95, middle}, ink, line);
    canvas.straight({p95, middle - height / 4}, {p95, middle + height / 4}, ink, line);
  }
}

void draw_row(Canvas& canvas, const PlotArea& area, const Row& row, double top, double height,
              const Columns& columns) {
  const Sizes& sizes = canvas.sizes();
  const double middle = top + height / 2;
  draw_bar(canvas, area, row, middle, kBarShare * height);
  const double baseline = middle + kHalfDigit * sizes.body;
  const double name_room = area.rect.left - sizes.gap - sizes.margin + 2;  // the area is rounded
  canvas.text(canvas.body(canvas.fitted(row.time.name, sizes.body, name_room),
                          {area.rect.left - sizes.gap, baseline}, HorizontalAlign::kRight));
  draw_numbers(canvas, columns, fixed_text(row.time.median_ms, columns.decimals),
               fixed_text(row.time.p95_ms, columns.decimals), baseline);
}

double longest_time(const std::vector<Row>& rows) {
  double longest = 0;
  for (const Row& row : rows) {
    for (const double time : {row.time.median_ms, row.time.p95_ms}) {
      if (std::isfinite(time)) longest = std::max(longest, time);
    }
  }
  return longest > 0 ? longest : 1;
}

}  // namespace

Drawing stage_times(std::span<const StageTime> stages, const std::optional<StageTime>& frame,
                    const Caption& caption, const Style& style) {
  Canvas canvas(style);
  const Sizes& sizes = canvas.sizes();
  std::vector<Row> rows;
  for (const StageTime& stage : stages) rows.push_back({stage, palette::kBlue});
  if (frame) rows.push_back({*frame, style.theme.other});
  const Rect page = draw_title_block(canvas, caption, "Time of each stage of a frame");
  if (rows.empty()) {
    draw_note(canvas, page, "no stages");
    return std::move(canvas).finish();
  }

  const double longest = longest_time(rows);
  const double column =
      1.3 * std::max(canvas.width_of("median", sizes.body), canvas.width_of("00.00", sizes.body));
  const Columns columns{page.right - column, page.right,
                        longest >= 1000  ? 0
                        : longest >= 100 ? 1
                                         : 2};
  PlotMargins margins;
  margins.left = std::min(widest_name(canvas, rows), kNamesShare * page.width()) + sizes.gap;
  Rect bars = page;
  bars.right -= 2 * column + sizes.gap;
  // Few stages do not need the whole height: bars as thick as books are no easier to read.
  const double rows_height = std::min(bars.height() - x_label_height(canvas),
                                      static_cast<double>(rows.size()) * kHighestRow * sizes.body);
  bars.bottom = bars.top + rows_height + x_label_height(canvas);
  PlotArea area =
      lay_out(canvas, bars, {"time", "ms", {0, 1.02 * longest}}, {"", "", {0, 1}}, margins);
  area.y_ticks = {};
  draw_axes(canvas, area, margins);
  const double heads = header_baseline(canvas, area);
  draw_numbers(canvas, columns, "median", "95 %", heads);
  canvas.text(coloured(canvas.body("bars to the median, lines to the 95th percentile of all frames",
                                   {area.rect.left, heads}),
                       style.theme.muted));
  const double height = area.rect.height() / static_cast<double>(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    draw_row(canvas, area, rows[i], area.rect.top + static_cast<double>(i) * height, height,
             columns);
  }
  return std::move(canvas).finish();
}

}  // namespace traverse::render
