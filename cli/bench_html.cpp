#include "bench.h"
#include "html.h"
#include "log_chart.h"

#include <fmt/core.h>

namespace prt::cli {
namespace {

/// A curve for each backend and method.
template <class X, class Y>
std::vector<ChartSeries> curves(const BenchResult& result, X&& x, Y&& y) {
    std::vector<ChartSeries> all;
    for (const BenchSeries& series : result.series) {
        ChartSeries curve{fmt::format("{} {}", series.backend, series.method), {}};
        for (const BenchRun& run : series.runs)
            curve.points.push_back({x(run), y(run),
                                    fmt::format("{} per receiver: {:.4g} s, {:.3f} %", run.rays, run.seconds,
                                                100 * run.relative_l2)});
        all.push_back(std::move(curve));
    }
    return all;
}

} // namespace

std::string bench_html(const BenchResult& result) {
    std::string page = html_begin("prt bench: " + result.scene, "Speed against error");
    page += fmt::format(
        "<p>{}: {} receivers, {} triangles, order {}, direct light. Errors are relative L2 against {} "
        "rays of another seed, over {} receivers.</p>\n",
        html_escaped(result.scene), result.receivers, result.triangles, result.order, result.reference_rays,
        result.reference_receivers);
    page += log_chart(curves(
                          result, [](const BenchRun& r) { return r.seconds; },
                          [](const BenchRun& r) { return 100 * r.relative_l2; }),
                      "seconds, all work counted", "error, %");
    page += log_chart(curves(
                          result, [](const BenchRun& r) { return static_cast<double>(r.rays); },
                          [](const BenchRun& r) { return 1e-6 * r.rays_per_second; }),
                      "rays or directions per receiver", "million rays or depth tests per second");
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
