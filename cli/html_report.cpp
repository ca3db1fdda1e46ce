#include "html_report.h"

#include "html.h"
#include "sweep_report.h"

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

std::string lights_table(const Evaluation& evaluation) {
    std::string html =
        "<table>\n<tr><th>light</th><th>lit_rms</th><th>lit_max</th><th>99.9 %</th><th>darker half</th>"
        "<th>seam</th><th>seams, 99 %</th><th>inner, 99 %</th><th>mean radiance</th></tr>\n";
    for (const auto& [name, e] : evaluation.lights)
        html += fmt::format(
            "<tr><td>{}</td><td>{:.4f} %</td><td>{:.3f} %</td><td>{:.3f} %</td><td>{:.3f} %</td>"
            "<td>{:.3f} %</td><td>{:.3f} %</td><td>{:.3f} %</td><td>{:.4g}</td></tr>\n",
            html_escaped(name), 100 * e.rms, 100 * e.max, 100 * e.percentile_999, 100 * e.darker_half_rms,
            100 * e.crossing.max, 100 * e.crossing.percentile_99, 100 * e.inner.percentile_99, e.mean);
    return html + "</table>\n<p>lit_rms: relative L2 of exit radiance for albedo 1. lit_max and 99.9 %: the "
                  "largest error of "
                  "a receiver, and that which 99.9 % stay below. Darker half: relative L2 of the half of the "
                  "area where the "
                  "radiance is least. Seam: the largest jump of the error along an edge between two "
                  "clusters; 99 %: what "
                  "99 % of such edges, and of those inside a cluster, stay below. All but the relative ones "
                  "are over the "
                  "mean radiance.</p>\n";
}

std::string clusters_table(const Evaluation& evaluation) {
    constexpr std::size_t kShown = 12;
    if (evaluation.clusters.empty())
        return {};
    std::string html =
        "<h2>Clusters with most of the error</h2>\n<table>\n<tr><th>cluster</th><th>vertices</th>"
        "<th>components</th><th>of the area</th><th>of the squared error</th><th>lit_rms</th></tr>\n";
    for (std::size_t i = 0; i < std::min(kShown, evaluation.clusters.size()); ++i) {
        const ClusterShare& c = evaluation.clusters[i];
        html += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.2f} %</td><td>{:.2f} %</td><td>{:.3f} %"
            "</td></tr>\n",
            c.cluster, c.receivers, c.components, 100 * c.area_share, 100 * c.error_share, 100 * c.lit_rms);
    }
    return html + "</table>\n";
}

std::string base64(const std::vector<std::byte>& bytes) {
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t b = 0; b < 3; ++b)
            group = group << 8 | (i + b < bytes.size() ? std::to_integer<unsigned>(bytes[i + b]) : 0u);
        for (std::size_t d = 0; d < 4; ++d)
            text += i + d > bytes.size() ? '=' : kDigits[group >> (18 - 6 * d) & 63];
    }
    return text;
}

} // namespace

std::string html_report(const Evaluation& evaluation) {
    const bool measured = !evaluation.shipped.empty();
    std::string page = html_begin("prt evaluate: " + (measured ? evaluation.shipped : evaluation.baked),
                                  measured ? "Compression error" : "Rate and distortion");
    if (measured) {
        page += fmt::format(
            "<p>{} against {}</p>\n<p>Relative L2 of the transfer vectors: <b>{:.4f} %</b></p>\n",
            html_escaped(evaluation.shipped), html_escaped(evaluation.baked), 100 * evaluation.relative_l2);
        page += lights_table(evaluation);
        page += bars(evaluation, "lit_rms", &LitError::rms);
        page += bars(evaluation, "lit_max", &LitError::max);
        if (!evaluation.worst_light.empty())
            page += fmt::format("<p>Worst of the directional lights: {}.</p>\n",
                                html_escaped(evaluation.worst_light));
        page += clusters_table(evaluation);
    }
    for (const auto& [title, png] : evaluation.pictures)
        page += fmt::format("<h2>{}</h2>\n<img alt=\"{}\" src=\"data:image/png;base64,{}\">\n",
                            html_escaped(title), html_escaped(title), base64(png));
    if (evaluation.sweep)
        page += sweep_html(*evaluation.sweep);
    page += "<h2>Sizes</h2>\n<table>\n";
    for (const auto& [name, value] : evaluation.facts)
        page += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", html_escaped(name), html_escaped(value));
    return page + "</table>\n" + html_end();
}

} // namespace prt::cli
