#include "html_report.h"

#include "html.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::cli {
namespace {

/// Horizontal bars of one measure over the lights.
std::string bars(const Evaluation& evaluation, const char* title, double LitError::*measure) {
    double largest = 1e-12;
    for (const auto& light : evaluation.lights)
        largest = std::max(largest, light.second.*measure);
    constexpr int kRow = 26, kLeft = 230, kBar = 420;
    const int height = kRow * static_cast<int>(evaluation.lights.size()) + 10;
    std::string svg =
        fmt::format("<h2>{}</h2>\n<svg width=\"800\" height=\"{}\" role=\"img\" aria-label=\"{}\">\n", title,
                    height, title);
    int y = 0;
    for (const auto& [name, error] : evaluation.lights) {
        const double value = error.*measure;
        svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\" font-size=\"14\">{}</text>"
                           "<rect x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"16\" fill=\"#3b76b0\"/>"
                           "<text x=\"{:.1f}\" y=\"{}\" font-size=\"14\">{:.3f} %</text>\n",
                           kLeft - 8, y + 16, html_escaped(name), kLeft, y + 3, kBar * value / largest,
                           kLeft + 8 + kBar * value / largest, y + 16, 100 * value);
        y += kRow;
    }
    return svg + "</svg>\n";
}

} // namespace

std::string html_report(const Evaluation& evaluation) {
    std::string page = html_begin("prt evaluate: " + evaluation.shipped, "Compression error");
    page += fmt::format("<p>{} against {}</p>\n<p>Relative L2 of the transfer vectors: <b>{:.4f} %</b></p>\n",
                        html_escaped(evaluation.shipped), html_escaped(evaluation.baked),
                        100 * evaluation.relative_l2);
    page += "<table>\n<tr><th>light</th><th>lit_rms</th><th>lit_max</th><th>seam</th><th>mean "
            "radiance</th></tr>\n";
    for (const auto& [name, error] : evaluation.lights)
        page += fmt::format(
            "<tr><td>{}</td><td>{:.4f} %</td><td>{:.3f} %</td><td>{:.3f} %</td><td>{:.4g}</td></tr>\n",
            html_escaped(name), 100 * error.rms, 100 * error.max, 100 * error.seam, error.mean);
    page += "</table>\n<p>lit_rms: relative L2 of exit radiance for albedo 1. lit_max: largest error of a "
            "receiver, "
            "seam: largest jump of the error along an edge between two clusters, both over the mean "
            "radiance.</p>\n";
    page += bars(evaluation, "lit_rms", &LitError::rms);
    page += bars(evaluation, "lit_max", &LitError::max);
    page += "<h2>Sizes</h2>\n<table>\n";
    for (const auto& [name, value] : evaluation.facts)
        page += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", html_escaped(name), html_escaped(value));
    return page + "</table>\n" + html_end();
}

} // namespace prt::cli
