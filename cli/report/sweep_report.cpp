// Reports rate and distortion of compression methods.

#include "cli/report/sweep_report.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::pipeline {
namespace {

std::vector<std::string> methods_of(const std::vector<SweepPoint>& points) {
    std::vector<std::string> methods;
    for (const SweepPoint& point : points)
        if (std::find(methods.begin(), methods.end(), point.method) == methods.end())
            methods.push_back(point.method);
    if (std::find(methods.begin(), methods.end(), kOurs) == methods.end())
        methods.push_back(kOurs);
    return methods;
}

/// Returns the Pareto front of a method's points: no other point is both cheaper and better. The cheapest is
/// first.
template <class Cost>
std::vector<SweepPoint> frontier(const std::vector<SweepPoint>& points, const std::string& method,
                                 Cost&& cost) {
    std::vector<SweepPoint> own;
    std::copy_if(points.begin(), points.end(), std::back_inserter(own),
                 [&](const SweepPoint& p) { return p.method == method; });
    std::stable_sort(own.begin(), own.end(),
                     [&](const SweepPoint& a, const SweepPoint& b) { return cost(a) < cost(b); });
    std::vector<SweepPoint> result;
    for (const SweepPoint& point : own)
        if (result.empty() || point.lit_rms < result.back().lit_rms)
            result.push_back(point);
    return result;
}

template <class Cost>
Chart chart(const std::vector<SweepPoint>& points, const char* x_title, Cost&& cost) {
    std::vector<ChartSeries> series;
    for (const std::string& method : methods_of(points)) {
        ChartSeries curve{method, {}, method == kOurs};
        for (const SweepPoint& p : frontier(points, method, cost))
            curve.points.push_back({cost(p), 100 * p.lit_rms,
                                    fmt::format("{}: {:.2f} bytes, {:.2f} operations, lit_rms {:.3f} %",
                                                p.setting, p.bytes(), p.mean_components, 100 * p.lit_rms)});
        series.push_back(std::move(curve));
    }
    return {x_title, "lit_rms, %", std::move(series)};
}

using Best = const SweepPoint* (*)(const Sweep&, const std::string&, double);

/// Returns a table of error and jumps of the best point of every method at each limit; our method has a row
/// even without a point.
template <class Limits>
Table best_table(const Sweep& sweep, const std::vector<SweepPoint>& points, const Limits& limits,
                 const char* unit, Best best) {
    Table table;
    table.columns.push_back({"method", "method", Unit::plain});
    for (const auto limit : limits) {
        table.columns.push_back(
            {"", fmt::format("{:g} {}", static_cast<double>(limit), unit), Unit::percent});
        table.columns.push_back({"", "jumps", Unit::percent});
    }
    for (const std::string& method : methods_of(points)) {
        std::vector<Json> row = {method};
        for (const auto limit : limits) {
            const SweepPoint* p = best(sweep, method, static_cast<double>(limit));
            row.push_back(p ? Json(p->lit_rms) : Json());
            row.push_back(p ? Json(p->jumps) : Json());
        }
        table.rows.push_back(std::move(row));
    }
    table.audience = Audience::people;
    return table;
}

/// Every point, for files.
Table points_table(const char* key, const std::vector<SweepPoint>& points) {
    Table table{key, "", "", {}, {}};
    for (const char* column : {"method", "setting", "payload_bytes_per_vertex", "table_bytes_per_vertex",
                               "bytes_per_vertex", "shader_operations"})
        table.columns.push_back({column, ""});
    for (const char* column : {"lit_rms", "jumps_percentile_99", "relative_l2"})
        table.columns.push_back({column, "", Unit::percent});
    table.columns.push_back({"seconds", "", Unit::seconds});
    for (const SweepPoint& p : points)
        table.rows.push_back({p.method, p.setting, p.payload_bytes, p.table_bytes, p.bytes(),
                              p.mean_components, p.lit_rms, p.jumps, p.relative_l2, p.seconds});
    table.audience = Audience::files;
    return table;
}

double ops_of(const SweepPoint& p) {
    return p.mean_components;
}
double bytes_of(const SweepPoint& p) {
    return p.bytes();
}

} // namespace

void add_sweep(const Sweep& sweep, Report& report) {
    Table bytes = best_table(sweep, sweep.by_bytes, kSweepBytes, "bytes", best_by_bytes);
    bytes.title = "Error at equal bytes";
    bytes.about =
        "Values: lit_rms and jumps of the best setting with at most this size. Bytes per vertex: attributes "
        "in whole 32-bit words, plus all tables divided by the number of vertices; the rule is the same for "
        "all methods. Jumps: difference of the error between the two ends of an edge, relative to the mean "
        "radiance, 99th percentile.";
    bytes.charts = {chart(sweep.by_bytes, "bytes per vertex, bases included", bytes_of)};
    Table ops = best_table(sweep, sweep.by_components, kSweepComponents, "operations", best_by_components);
    ops.title = "Error at equal shader operations";
    ops.about = fmt::format(
        "Values: as above, with at most this number of operations. Operations: mean number of multiply-adds "
        "of a colour per vertex. Clustered methods of the literature use {} clusters, or one per {} "
        "vertices if that is fewer; prtkit uses any number of clusters that needs no more bytes than "
        "classic CPCA with the same operations.",
        kSweepClusters, kMinReceiversPerCluster);
    ops.charts = {chart(sweep.by_components, "multiply-adds per vertex", ops_of)};
    report.tables.push_back(std::move(bytes));
    report.tables.push_back(std::move(ops));
    report.tables.push_back(points_table("sweep/equal_bytes", sweep.by_bytes));
    report.tables.push_back(points_table("sweep/equal_shader_operations", sweep.by_components));
    for (const std::string& missing : sweep.left_out)
        report.notes.push_back(std::string(kOurs) + ": " + missing);
}

} // namespace prt::pipeline
