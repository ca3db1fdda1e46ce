#include "bench.h"
#include "classic.h"
#include "commands/commands.h"
#include "outputs.h"

#include "report/write_report.h"

#include <fmt/core.h>

namespace prt::cli {
namespace {

/// The table of Hill's article, with what was measured beside it.
Table classic_table() {
    Table table{"classic", "The table of Hill, 2004", "", {}, {}};
    table.columns = {{"vertices", "vertices"},
                     {"series", "backend, method"},
                     {"samples", "samples"},
                     {"seconds", "seconds", Unit::seconds, 4},
                     {"seconds_d3dx_2004", "D3DX", Unit::seconds, 2},
                     {"times_faster_than_d3dx", "times faster"},
                     {"seconds_hill_2004", "Hill", Unit::seconds, 2},
                     {"times_faster_than_hill", "times faster"},
                     {"relative_l2", "error", Unit::percent}};
    table.about =
        "Seconds to bake meshes of as many vertices, all work counted; his own meshes are not published.";
    return table;
}

void add_rows(const ClassicRow& row, const BenchResult& result, Table& table) {
    for (const BenchSeries& series : result.series)
        for (const BenchRun& run : series.runs)
            table.rows.push_back({row.vertices, series.backend + " " + series.method, run.rays, run.seconds,
                                  row.seconds_d3dx, row.seconds_d3dx / run.seconds, row.seconds_hill,
                                  row.seconds_hill / run.seconds, run.relative_l2});
}

Report scene_report(const BenchArguments& a, Interrupt& interrupt) {
    const GltfDocument document = load_gltf(a.scene);
    const Scene scene = extract_scene(document);
    print_notices(a.scene.string(), scene.notices);
    ProgressBar bar("measuring", interrupt.token());
    Report report = bench_report(run_bench(a.scene.string(), scene, a.options, bar.progress()));
    report.notices = scene.notices;
    return report;
}

Report classic_report(const BenchArguments& a, Interrupt& interrupt) {
    Report report;
    report.title = "Bakes of 2004";
    BenchOptions options = a.options;
    options.fewest_rays = kClassicSamples.front();
    options.most_rays = kClassicSamples.back();
    Table table = classic_table();
    for (const ClassicRow& row : classic_rows()) {
        ProgressBar bar(fmt::format("measuring {} vertices", row.vertices), interrupt.token());
        const BenchResult result = run_bench(fmt::format("bumpy torus, {} vertices", row.vertices), row.scene,
                                             options, bar.progress());
        add_rows(row, result, table);
        for (const BenchSeries& series : result.series)
            if (!series.left_out.empty())
                report.notes.push_back(fmt::format("{} vertices, {} {}: {}", row.vertices, series.backend,
                                                   series.method, series.left_out));
    }
    report.tables.push_back(std::move(table));
    return report;
}

} // namespace

void run(const BenchArguments& a, Interrupt& interrupt) {
    check_outputs(
        {{a.json, "--json", {".json"}}, {a.html, "--html", {".html", ".htm"}}, {a.csv, "--csv", {".csv"}}},
        {a.scene});
    Report report = a.classic ? classic_report(a, interrupt) : scene_report(a, interrupt);
    report.origin.emplace_back("command", a.command_line);
    publish(report, {a.json, a.html, a.csv}, interrupt);
}

} // namespace prt::cli
