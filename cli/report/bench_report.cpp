// Reports the timings of prt bench.

#include "cli/report/bench_report.h"

#include <fmt/core.h>

namespace prt::pipeline {
namespace {

/// A curve for each backend and method.
template <class X, class Y>
std::vector<ChartSeries> curves(const BenchResult& result, X&& x, Y&& y) {
    std::vector<ChartSeries> all;
    for (const BenchSeries& series : result.series) {
        ChartSeries curve{series.name(), {}};
        for (const BenchRun& run : series.runs)
            curve.points.push_back({x(run), y(run),
                                    fmt::format("{} per receiver: {:.4g} s, error {:.3f} %", run.rays,
                                                run.seconds, 100 * run.relative_l2)});
        if (!curve.points.empty())
            all.push_back(std::move(curve));
    }
    return all;
}

/// All runs, one a line.
Table runs_table(const BenchResult& result) {
    Table table{"runs", "Runs", "", {}, {}};
    table.columns = {{"series", "backend, method"},
                     {"rays", "rays per receiver"},
                     {"seconds", "total time", Unit::seconds},
                     {"seconds_build", "build", Unit::seconds},
                     {"seconds_trace", "trace", Unit::seconds},
                     {"seconds_accumulate", "accumulate", Unit::seconds},
                     {"seconds_transfer", "GPU copies", Unit::seconds},
                     {"rays_per_second", "rays/s"},
                     {"relative_l2", "error at vertices", Unit::percent},
                     {"contrast", "contrast error at vertices", Unit::percent},
                     {"surface_l2", "error over the surface", Unit::percent}};
    for (const BenchSeries& series : result.series)
        for (const BenchRun& r : series.runs)
            table.rows.push_back({series.name(), r.rays, r.seconds, r.seconds_build, r.stages.trace,
                                  r.stages.accumulate, r.stages.transfer, r.rays_per_second, r.relative_l2,
                                  r.contrast, r.surface_l2});
    table.about =
        "Build: acceleration structure, upload, shaders. Trace: tracing rays or drawing depth maps; on the "
        "GPU this includes the sums of spherical harmonics. Accumulate: sums of spherical harmonics on the "
        "CPU; depth tests with method raster. GPU copies: copies to and from the GPU. Rays/s: rays or depth "
        "tests per second of total time. Contrast error: error at each vertex relative to its own transfer "
        "plus a tenth of the logarithmic mean of all. Fitted: vertex values are a least-squares fit to "
        "samples of the surface; this increases the error at the vertices themselves.";
    table.charts = {{"total time, s", "error at vertices, %",
                     curves(
                         result, [](const BenchRun& r) { return r.seconds; },
                         [](const BenchRun& r) { return 100 * r.relative_l2; })},
                    {"total time, s", "error over the surface, %",
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
        {{"reference_rays", "rays per receiver of the reference (another seed)"}, result.reference_rays},
        {{"reference_receivers", "receivers with measured errors"}, result.reference_receivers}};
    for (const BenchSeries& series : result.series)
        report.origin.emplace_back(series.name(), series.device);
    report.tables.push_back(runs_table(result));
    for (const BenchSeries& series : result.series)
        if (!series.left_out.empty())
            report.notes.push_back(series.name() + ": " + series.left_out);
    return report;
}

} // namespace prt::pipeline
