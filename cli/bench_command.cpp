#include "bench.h"
#include "classic.h"
#include "commands.h"
#include "html.h"

#include "prt/error.h"
#include "prt/file.h"
#include "report.h"

#include <fmt/core.h>

namespace prt::cli {
namespace {

Json run_json(const BenchRun& r) {
    return {{"rays", r.rays},
            {"seconds", r.seconds},
            {"seconds_build", r.seconds_build},
            {"seconds_trace", r.parts.trace},
            {"seconds_accumulate", r.parts.accumulate},
            {"seconds_transfer", r.parts.transfer},
            {"rays_per_second", r.rays_per_second},
            {"relative_l2", r.relative_l2}};
}

Json series_json(const BenchResult& result) {
    Json all = Json::array();
    for (const BenchSeries& series : result.series) {
        Json runs = Json::array();
        for (const BenchRun& run : series.runs)
            runs.push_back(run_json(run));
        all.push_back({{"backend", series.backend},
                       {"method", series.method},
                       {"device", series.device},
                       {"runs", runs},
                       {"left_out", series.left_out}});
    }
    return all;
}

Json result_json(const BenchResult& result) {
    return {{"scene", result.scene},
            {"receivers", result.receivers},
            {"triangles", result.triangles},
            {"order", result.order},
            {"reference_rays", result.reference_rays},
            {"reference_receivers", result.reference_receivers},
            {"series", series_json(result)}};
}

void print_result(const BenchResult& result) {
    fmt::print("{}: {} receivers, {} triangles, order {}; errors against {} rays, over {} receivers\n",
               result.scene, result.receivers, result.triangles, result.order, result.reference_rays,
               result.reference_receivers);
    for (const BenchSeries& series : result.series) {
        fmt::print("{} {}, {}\n", series.backend, series.method, series.device);
        if (!series.runs.empty())
            fmt::print("     rays   seconds     build     trace accumulate transfer  million/s   error\n");
        for (const BenchRun& r : series.runs)
            fmt::print("  {:>7} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>10.2f} {:>6.3f} %\n", r.rays,
                       r.seconds, r.seconds_build, r.parts.trace, r.parts.accumulate, r.parts.transfer,
                       r.rays_per_second * 1e-6, 100 * r.relative_l2);
        if (!series.left_out.empty())
            fmt::print("  left out: {}\n", series.left_out);
    }
}

void write_page(const Path& path, const std::string& page, Interrupt& interrupt) {
    if (path.empty())
        return;
    const Interrupt::WritingScope writing(interrupt);
    OutputFile file(path);
    file.write(page);
    file.commit();
}

void run_scene(const BenchArguments& a, Interrupt& interrupt) {
    const GltfDocument document = load_gltf(a.scene);
    const Scene scene = extract_scene(document);
    print_notices(a.scene.string(), scene.notices);
    BenchResult result;
    {
        ProgressBar bar("measuring", interrupt.token());
        result = run_bench(a.scene.string(), scene, a.options, bar.progress());
    }
    print_result(result);
    Json report = result_json(result);
    report["notices"] = scene.notices;
    write_json(report, a.json, interrupt);
    write_page(a.html, bench_html(result), interrupt);
}

void run_classic(const BenchArguments& a, Interrupt& interrupt) {
    Json rows = Json::array();
    std::string page = html_begin("prt bench --classic", "The table of Hill, 2004");
    page += "<p>Seconds to bake meshes of as many vertices, all work counted; his own meshes are not "
            "published.</p>\n";
    const auto mesh = classic_rows();
    BenchOptions options = a.options;
    options.fewest_rays = kClassicSamples.front();
    options.most_rays = kClassicSamples.back();
    for (const ClassicRow& row : mesh) {
        BenchResult result;
        {
            ProgressBar bar(fmt::format("measuring {} vertices", row.vertices), interrupt.token());
            result = run_bench(fmt::format("bumpy torus, {} vertices", row.vertices), row.scene, options,
                               bar.progress());
        }
        fmt::print("{} vertices: D3DX {:.2f} s, Hill's fastest {:.2f} s (2004)\n", row.vertices,
                   row.seconds_d3dx, row.seconds_hill);
        page += fmt::format(
            "<h2>{} vertices</h2>\n<p>D3DX {:.2f} s, Hill's fastest {:.2f} s (2004).</p>\n"
            "<table>\n<tr><th>backend, method</th><th>samples</th><th>seconds</th><th>times faster than "
            "D3DX</th><th>than Hill</th><th>error</th></tr>\n",
            row.vertices, row.seconds_d3dx, row.seconds_hill);
        for (const BenchSeries& series : result.series) {
            for (const BenchRun& run : series.runs) {
                const double d3dx = row.seconds_d3dx / run.seconds, hill = row.seconds_hill / run.seconds;
                fmt::print("  {} {:<6} {:>5} samples: {:>8.4f} s, {:>7.1f} x D3DX, {:>6.2f} x Hill, error "
                           "{:.3f} %\n",
                           series.backend, series.method, run.rays, run.seconds, d3dx, hill,
                           100 * run.relative_l2);
                page += fmt::format(
                    "<tr><td>{} {}</td><td>{}</td><td>{:.4f}</td><td>{:.1f}</td><td>{:.2f}</td>"
                    "<td>{:.3f} %</td></tr>\n",
                    series.backend, series.method, run.rays, run.seconds, d3dx, hill, 100 * run.relative_l2);
            }
            if (!series.left_out.empty())
                fmt::print("  {} {}: left out: {}\n", series.backend, series.method, series.left_out);
        }
        page += "</table>\n";
        Json json = result_json(result);
        json["seconds_d3dx_2004"] = row.seconds_d3dx;
        json["seconds_hill_2004"] = row.seconds_hill;
        rows.push_back(std::move(json));
    }
    write_json({{"classic", rows}}, a.json, interrupt);
    write_page(a.html, page + html_end(), interrupt);
}

} // namespace

void run(const BenchArguments& a, Interrupt& interrupt) {
    if (a.classic)
        run_classic(a, interrupt);
    else
        run_scene(a, interrupt);
}

} // namespace prt::cli
