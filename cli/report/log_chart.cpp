#include "report/log_chart.h"

#include "report/html.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace prt::cli {
namespace {

constexpr std::size_t kColors = 8; ///< --series-0.. of report/page.html
constexpr int kWidth = 800, kHeight = 420, kLeft = 80, kRight = 190, kTop = 28, kBottom = 46;

/// Values of one axis, from the least to the largest with a margin.
class Axis {
public:
    void extend(double value) {
        low_ = std::min(low_, value / 1.15);
        high_ = std::max(high_, value * 1.15);
    }
    double share(double value) const { return std::log(value / low_) / std::log(high_ / low_); }
    /// 1, 2 and 5 times the powers of ten.
    std::vector<double> ticks() const {
        std::vector<double> result;
        for (double decade = std::pow(10, std::floor(std::log10(low_))); decade <= high_ * 1.001;
             decade *= 10)
            for (const double t : {decade, 2 * decade, 5 * decade})
                if (t >= low_ && t <= high_)
                    result.push_back(t);
        return result;
    }

private:
    double low_ = 1e300, high_ = 1e-300;
};

struct Axes {
    Axis x, y;
    double place_x(double value) const { return kLeft + x.share(value) * (kWidth - kLeft - kRight); }
    double place_y(double value) const {
        return kHeight - kBottom - y.share(value) * (kHeight - kTop - kBottom);
    }
};

bool shown(const ChartPoint& point) {
    return point.x > 0 && point.y > 0;
}

std::string grid(const Axes& axes) {
    std::string out;
    for (const double t : axes.x.ticks())
        out += fmt::format("<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" class=\"grid\"/>"
                           "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
                           axes.place_x(t), kTop, kHeight - kBottom, kHeight - kBottom + 18, t);
    for (const double t : axes.y.ticks())
        out += fmt::format("<line y1=\"{0:.1f}\" y2=\"{0:.1f}\" x1=\"{1}\" x2=\"{2}\" class=\"grid\"/>"
                           "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
                           axes.place_y(t), kLeft, kWidth - kRight, kLeft - 6, axes.place_y(t) + 4, t);
    return out;
}

/// A curve with its points, and a line of the legend: a stroke in its colour, the name as text.
std::string curve(const ChartSeries& series, const Axes& axes, std::size_t row) {
    const std::string color = series.strong ? "var(--text)" : fmt::format("var(--series-{})", row % kColors);
    const char* kind = series.strong ? "curve strong" : "curve";
    std::string points, dots;
    for (const ChartPoint& point : series.points) {
        if (!shown(point))
            continue;
        const double x = axes.place_x(point.x), y = axes.place_y(point.y);
        points += fmt::format("{:.1f},{:.1f} ", x, y);
        dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" style=\"fill:{}\"><title>{}</title>"
                            "</circle>\n",
                            x, y, series.strong ? 5 : 3.5, color, html_escaped(point.label));
    }
    const int left = kWidth - kRight + 12, middle = kTop + 10 + 22 * static_cast<int>(row);
    return fmt::format(
        "<polyline class=\"{0}\" style=\"stroke:{1}\" points=\"{2}\"/>\n{3}"
        "<line class=\"{0}\" style=\"stroke:{1}\" x1=\"{4}\" x2=\"{5}\" y1=\"{6}\" y2=\"{6}\"/>"
        "<text x=\"{7}\" y=\"{8}\">{9}</text>\n",
        kind, color, points, dots, left, left + 22, middle, left + 30, middle + 4, html_escaped(series.name));
}

} // namespace

std::string log_chart(const std::vector<ChartSeries>& series, const std::string& x_title,
                      const std::string& y_title) {
    Axes axes;
    for (const ChartSeries& s : series)
        for (const ChartPoint& point : s.points)
            if (shown(point)) {
                axes.x.extend(point.x);
                axes.y.extend(point.y);
            }
    std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} over {}\">\n",
                                  kWidth, kHeight, html_escaped(y_title), html_escaped(x_title));
    out += grid(axes);
    out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                       (kLeft + kWidth - kRight) / 2, kHeight - 6, html_escaped(x_title));
    out += fmt::format("<text x=\"{}\" y=\"16\">{}</text>\n", kLeft, html_escaped(y_title));
    for (std::size_t i = 0; i < series.size(); ++i)
        out += curve(series[i], axes, i);
    return out + "</svg>\n";
}

} // namespace prt::cli
