// Reports the timings of prt bench.

#include "report/bench_report.h"

#include <fmt/core.h>

namespace prt::cli {
namespace {

/// A curve for each backend and method.
template <class X, class Y>
std::vector<ChartSeries> curves(const BenchResult& result, X&& x, Y&& y) {
    std::vector<ChartSeries> all;
    for (const BenchSeries& series : result.series) {
        ChartSeries curve{series.name(), {}};
        for (const BenchRun& run : series.runs)
            curve.points.push_back({x(run), y(run),
                                    fmt::format("{} per receiver: {:.4g} s, {:.3f} %", run.rays, run.seconds,
                                                100 * run.relative_l2)});
        if (!curve.points.empty())
            all.push_back(std::move(curve));
    }
    return all;
}

/// All runs, one a line.
Table runs_table(const BenchResult& result) {
    Table table{"runs", "Runs", "", {}, {}};
    table.columns = {{"series", "backend, method"},
                     {"rays", "per receiver"},
                     {"seconds", "seconds", Unit::seconds},
                     {"seconds_build", "build", Unit::seconds},
                     {"seconds_trace", "trace", Unit::seconds},
                     {"seconds_accumulate", "accumulate", Unit::seconds},
                     {"seconds_transfer", "transfer", Unit::seconds},
                     {"rays_per_second", "rays/s"},
                     {"relative_l2", "error at vertices", Unit::percent},
                     {"contrast", "contrast error at vertices", Unit::percent},
                     {"surface_l2", "over the surface", Unit::percent}};
    for (const BenchSeries& series : result.series)
        for (const BenchRun& r : series.runs)
            table.rows.push_back({series.name(), r.rays, r.seconds, r.seconds_build, r.stages.trace,
                                  r.stages.accumulate, r.stages.transfer, r.rays_per_second, r.relative_l2,
                                  r.contrast, r.surface_l2});
    table.about =
        "build: hierarchy, upload, shaders. trace: rays, or drawing depth maps; on the GPU with the "
        "spherical "
        "harmonics, which are summed on chip. accumulate: spherical harmonics on the CPU, depth tests with "
        "method raster. transfer: to and from the GPU. Rays or depth tests per second, all work counted. "
        "Contrast error: at each vertex relative to its own transfer and a tenth of the logarithmic mean of "
        "all. "
        "Fitted: vertices have the "
        "values whose interpolation comes nearest to samples of the surface; at the vertices themselves that "
        "is farther off.";
    table.charts = {{"seconds, all work counted", "error at vertices, %",
                     curves(
                         result, [](const BenchRun& r) { return r.seconds; },
                         [](const BenchRun& r) { return 100 * r.relative_l2; })},
                    {"seconds, all work counted", "error over the surface, %",
                     curves(
                         result, [](const BenchRun& r) { return r.seconds; },
                         [](const BenchRun& r) { return 100 * r.surface_l2; })},
                    {"rays or directions per receiver", "million rays or depth tests per second",
                     curves(
                         result, [](const BenchRun& r) { return static_cast<double>(r.rays); },
                         [](const BenchRun& r) { return 1e-6 * r.rays_per_second; })}};
    return table;
}

} // namespace

Report bench_report(const BenchResult& result) {
    Report report;
    report.title = "Speed against error: " + result.scene;
    report.origin = {{"scene", result.scene}};
    report.figures = {
        {{"receivers", "receivers"}, result.receivers},
        {{"triangles", "triangles"}, result.triangles},
        {{"order", "order"}, result.order},
        {{"reference_rays", "rays of the reference, of another seed"}, result.reference_rays},
        {{"reference_receivers", "receivers that errors are over"}, result.reference_receivers}};
    for (const BenchSeries& series : result.series)
        report.origin.emplace_back(series.name(), series.device);
    report.tables.push_back(runs_table(result));
    for (const BenchSeries& series : result.series)
        if (!series.left_out.empty())
            report.notes.push_back(series.name() + ": " + series.left_out);
    return report;
}

} // namespace prt::cli
