#include "sweep_report.h"

#include "html.h"
#include "log_chart.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::cli {
namespace {

std::vector<std::string> methods_of(const std::vector<SweepPoint>& points) {
    std::vector<std::string> methods;
    for (const SweepPoint& point : points)
        if (std::find(methods.begin(), methods.end(), point.method) == methods.end())
            methods.push_back(point.method);
    return methods;
}

/// The points of a method than which none is cheaper and better, from the cheapest on.
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
std::string chart(const std::vector<SweepPoint>& points, const char* x_title, Cost&& cost) {
    std::vector<ChartSeries> series;
    for (const std::string& method : methods_of(points)) {
        ChartSeries curve{method, {}, method == kOurs};
        for (const SweepPoint& p : frontier(points, method, cost))
            curve.points.push_back({cost(p), 100 * p.lit_rms,
                                    fmt::format("{}: {:.2f} bytes, {:.2f} operations, {:.3f} %", p.setting,
                                                p.bytes(), p.shader_ops, 100 * p.lit_rms)});
        series.push_back(std::move(curve));
    }
    return log_chart(series, x_title, "lit_rms, %");
}

using Best = const SweepPoint* (*)(const Sweep&, const std::string&, double);

/// The best of every method for each limit.
template <class Limits>
std::string table(const Sweep& sweep, const std::vector<SweepPoint>& points, const Limits& limits,
                  const char* unit, Best best) {
    std::string html = "<table>\n<tr><th>lit_rms at most</th>";
    for (const auto limit : limits)
        html += fmt::format("<th>{:g} {}</th>", static_cast<double>(limit), unit);
    html += "</tr>\n";
    for (const std::string& method : methods_of(points)) {
        html += fmt::format("<tr><td>{}</td>", html_escaped(method));
        for (const auto limit : limits) {
            const SweepPoint* p = best(sweep, method, static_cast<double>(limit));
            html +=
                p ? fmt::format("<td title=\"{}\">{:.3f} %</td>", html_escaped(p->setting), 100 * p->lit_rms)
                  : std::string("<td></td>");
        }
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

double ops_of(const SweepPoint& p) {
    return p.shader_ops;
}
double bytes_of(const SweepPoint& p) {
    return p.bytes();
}

Json points_json(const std::vector<SweepPoint>& points) {
    Json list = Json::array();
    for (const SweepPoint& p : points)
        list.push_back({{"method", p.method},
                        {"setting", p.setting},
                        {"payload_bytes_per_vertex", p.payload_bytes},
                        {"table_bytes_per_vertex", p.table_bytes},
                        {"bytes_per_vertex", p.bytes()},
                        {"shader_operations", p.shader_ops},
                        {"lit_rms", p.lit_rms},
                        {"relative_l2", p.relative_l2},
                        {"seconds", p.seconds}});
    return list;
}

template <class Limits>
void print_table(const Sweep& sweep, const std::vector<SweepPoint>& points, const Limits& limits,
                 const char* unit, Best best) {
    fmt::print("  {:<22}", fmt::format("lit_rms at most, {}", unit));
    for (const auto limit : limits)
        fmt::print(" {:>9g}", static_cast<double>(limit));
    fmt::print("\n");
    for (const std::string& method : methods_of(points)) {
        fmt::print("  {:<22}", method);
        for (const auto limit : limits) {
            const SweepPoint* p = best(sweep, method, static_cast<double>(limit));
            fmt::print(" {:>9}", p ? fmt::format("{:.3f} %", 100 * p->lit_rms) : "");
        }
        fmt::print("\n");
    }
}

} // namespace

std::string sweep_html(const Sweep& sweep) {
    return "<h2>Error at equal bytes</h2>\n<p>Bytes per vertex: payload, and all tables over the "
           "vertices.</p>\n" +
           chart(sweep.by_bytes, "bytes per vertex, bases counted in", bytes_of) +
           table(sweep, sweep.by_bytes, kSweepBytes, "bytes", best_by_bytes) +
           fmt::format(
               "<h2>Error at equal shader operations</h2>\n<p>Multiply-adds of a colour per vertex, on "
               "average. Clustered methods of the literature have {} clusters; prtkit has as many as take no "
               "more bytes than classic CPCA at the same operations.</p>\n",
               kSweepClusters) +
           chart(sweep.by_ops, "multiply-adds per vertex", ops_of) +
           table(sweep, sweep.by_ops, kSweepOps, "operations", best_by_ops);
}

Json sweep_json(const Sweep& sweep) {
    return {{"equal_bytes", points_json(sweep.by_bytes)},
            {"equal_shader_operations", points_json(sweep.by_ops)}};
}

void print_sweep(const Sweep& sweep) {
    print_table(sweep, sweep.by_bytes, kSweepBytes, "bytes", best_by_bytes);
    print_table(sweep, sweep.by_ops, kSweepOps, "operations", best_by_ops);
}

} // namespace prt::cli
