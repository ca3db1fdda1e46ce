#include "bench.h"
#include "html.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace prt::cli {
namespace {

constexpr std::array kColors = {"#1f6fb4", "#d1611c", "#3a923a", "#8a5ab0"};

/// A chart with logarithmic axes, one curve per series.
class LogChart {
public:
    using Value = std::function<double(const BenchRun&)>;

    LogChart(const BenchResult& result, Value x, Value y)
        : result_(result), x_(std::move(x)), y_(std::move(y)) {
        for (const BenchSeries& series : result.series)
            for (const BenchRun& run : series.runs) {
                extend(x_range_, x_(run));
                extend(y_range_, y_(run));
            }
    }

    std::string svg(const char* x_title, const char* y_title) const {
        std::string out =
            fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" role=\"img\" aria-label=\"{} over {}\" "
                        "font-size=\"13\">\n",
                        kWidth, kHeight, kWidth, y_title, x_title);
        for (double tick = decade_below(x_range_[0]); tick <= x_range_[1] * 1.001; tick *= 10)
            for (const double t : {tick, 2 * tick, 5 * tick})
                if (t >= x_range_[0] && t <= x_range_[1])
                    out += fmt::format(
                        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#e4e4e4\"/>"
                        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
                        place_x(t), kTop, kHeight - kBottom, kHeight - kBottom + 18, t);
        for (double tick = decade_below(y_range_[0]); tick <= y_range_[1] * 1.001; tick *= 10)
            for (const double t : {tick, 2 * tick, 5 * tick})
                if (t >= y_range_[0] && t <= y_range_[1])
                    out += fmt::format(
                        "<line y1=\"{0:.1f}\" y2=\"{0:.1f}\" x1=\"{1}\" x2=\"{2}\" stroke=\"#e4e4e4\"/>"
                        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
                        place_y(t), kLeft, kWidth - kRight, kLeft - 6, place_y(t) + 4, t);
        out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                           (kLeft + kWidth - kRight) / 2, kHeight - 6, x_title);
        out += fmt::format("<text x=\"{}\" y=\"16\">{}</text>\n", kLeft, y_title);
        for (std::size_t i = 0; i < result_.series.size(); ++i)
            out += curve(result_.series[i], kColors[i % kColors.size()], i);
        return out + "</svg>\n";
    }

private:
    static constexpr int kWidth = 760, kHeight = 420, kLeft = 80, kRight = 150, kTop = 28, kBottom = 46;

    static void extend(std::array<double, 2>& range, double value) {
        if (!(value > 0))
            return;
        range[0] = std::min(range[0], value / 1.15);
        range[1] = std::max(range[1], value * 1.15);
    }
    static double decade_below(double value) { return std::pow(10, std::floor(std::log10(value))); }
    static double share(const std::array<double, 2>& range, double value) {
        return std::log(value / range[0]) / std::log(range[1] / range[0]);
    }
    double place_x(double value) const { return kLeft + share(x_range_, value) * (kWidth - kLeft - kRight); }
    double place_y(double value) const {
        return kHeight - kBottom - share(y_range_, value) * (kHeight - kTop - kBottom);
    }

    std::string curve(const BenchSeries& series, const char* color, std::size_t row) const {
        std::string points, dots;
        for (const BenchRun& run : series.runs) {
            if (!(x_(run) > 0) || !(y_(run) > 0))
                continue;
            points += fmt::format("{:.1f},{:.1f} ", place_x(x_(run)), place_y(y_(run)));
            dots += fmt::format(
                "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"><title>{} per receiver: {:.4g} "
                "s, {:.3f} %</title></circle>\n",
                place_x(x_(run)), place_y(y_(run)), color, run.rays, run.seconds, 100 * run.relative_l2);
        }
        const int y = kTop + 14 + 20 * static_cast<int>(row);
        return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n{}"
                           "<text x=\"{}\" y=\"{}\" fill=\"{}\">{} {}</text>\n",
                           points, color, dots, kWidth - kRight + 10, y, color, series.backend,
                           series.method);
    }

    const BenchResult& result_;
    Value x_, y_;
    std::array<double, 2> x_range_{1e300, 1e-300}, y_range_{1e300, 1e-300};
};

} // namespace

std::string bench_html(const BenchResult& result) {
    std::string page = html_begin("prt bench: " + result.scene, "Speed against error");
    page += fmt::format(
        "<p>{}: {} receivers, {} triangles, order {}, direct light. Errors are relative L2 against {} "
        "rays of another seed, over {} receivers.</p>\n",
        html_escaped(result.scene), result.receivers, result.triangles, result.order, result.reference_rays,
        result.reference_receivers);
    page += LogChart(
                result, [](const BenchRun& r) { return r.seconds; },
                [](const BenchRun& r) { return 100 * r.relative_l2; })
                .svg("seconds, all work counted", "error, %");
    page += LogChart(
                result, [](const BenchRun& r) { return static_cast<double>(r.rays); },
                [](const BenchRun& r) { return 1e-6 * r.rays_per_second; })
                .svg("rays or directions per receiver", "million rays or depth tests per second");
    for (const BenchSeries& series : result.series) {
        page += fmt::format("<h2>{} {}</h2>\n<p>{}</p>\n", series.backend, series.method,
                            html_escaped(series.device));
        if (!series.runs.empty())
            page += "<table>\n<tr><th>per "
                    "receiver</th><th>seconds</th><th>build</th><th>trace</th><th>accumulate</th>"
                    "<th>transfer</th><th>million/s</th><th>error</th></tr>\n";
        for (const BenchRun& r : series.runs)
            page += fmt::format(
                "<tr><td>{}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}"
                "</td><td>{:.2f}</td><td>{:.3f} %</td></tr>\n",
                r.rays, r.seconds, r.seconds_build, r.parts.trace, r.parts.accumulate, r.parts.transfer,
                1e-6 * r.rays_per_second, 100 * r.relative_l2);
        if (!series.runs.empty())
            page += "</table>\n";
        if (!series.left_out.empty())
            page += fmt::format("<p>Left out: {}.</p>\n", html_escaped(series.left_out));
    }
    page += "<p>build: hierarchy, upload, shaders. trace: rays, or drawing depth maps; on the GPU with the "
            "spherical "
            "harmonics, which are summed on chip. accumulate: spherical harmonics on the CPU, depth tests "
            "with method "
            "raster. transfer: to and from the GPU.</p>\n";
    return page + html_end();
}

} // namespace prt::cli
