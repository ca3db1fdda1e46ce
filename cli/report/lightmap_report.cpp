// Reports a bake into a lightmap.

#include "cli/report/lightmap_report.h"

#include "cli/report/transfer_words.h"
#include "runtime/core/support/counted.h"

#include <fmt/ranges.h>

#include <vector>

namespace prt::pipeline {
namespace {

Json statistics_json(const LightmapStatistics& s) {
    return {{"texels", s.texels.all},
            {"receivers", s.texels.receivers},
            {"texels_measured", s.texels.measured},
            {"texels_enclosed", s.texels.sealed},
            {"sources", s.sources},
            {"rays", s.rays},
            {"device", s.device},
            {"seconds", s.seconds.all},
            {"seconds_sources", s.seconds.sources},
            {"seconds_texels", s.seconds.texels},
            {"rays_per_second", s.rays_per_second()},
            {"mean_visibility", s.mean_visibility},
            {"sampling_error_relative_l2", s.sampling_error},
            {"float16_error_relative_l2", s.rounding_error},
            {"seam_before_rms", s.seam_before},
            {"seam_rms", s.seam},
            {"notices", s.notices}};
}

} // namespace

Json maps_figures(const LightmapLayout& layout) {
    Json maps = Json::array();
    for (const LightmapSize& map : layout.maps)
        maps.push_back({{"width", map.width}, {"height", map.height}});
    return maps;
}

std::string maps_in_words(const LightmapLayout& layout) {
    std::vector<std::string> sizes;
    for (const LightmapSize& map : layout.maps)
        sizes.push_back(fmt::format("{} x {}", map.width, map.height));
    if (sizes.size() > 4) {
        sizes.resize(3);
        sizes.emplace_back("and others");
    }
    return fmt::format("{}, {}", counted(layout.maps.size(), "map"), fmt::join(sizes, ", "));
}

Report lightmap_report(const LightmapOutcome& baked) {
    const BakedLightmap& lightmap = baked.bake.lightmap;
    const LightmapStatistics& s = baked.bake.statistics;
    Report report;
    add_figures(report, {{"output", baked.output},
                         {"order", lightmap.baked.transfer.layout.order},
                         {"channels", lightmap.baked.transfer.layout.channels()},
                         {"terms", terms_figures(lightmap.baked.transfer.layout)},
                         {"maps", maps_figures(lightmap.layout)},
                         {"storage", to_string(lightmap.baked.storage)},
                         {"bake", bake_record_json(lightmap.baked.record)},
                         {"triangles", baked.scene.triangles()}});
    Json statistics = statistics_json(s);
    for (const std::string& notice : baked.scene.notices)
        statistics["notices"].push_back(notice);
    add_figures(report, statistics);
    add_figures(report, {{"bytes_file", baked.bytes}});
    report.sentences = {
        fmt::format("{{output}}: {}, {{texels_measured:#texel}} on {{triangles:#triangle}}, order {{order}}, "
                    "{}, {{bake/rays_per_receiver:#ray}} per texel, {{bake/bounces:#bounce}}",
                    maps_in_words(lightmap.layout), terms_in_words(lightmap.baked.transfer.layout)),
        fmt::format("ray tracing on the {}: {{device}}",
                    lightmap.baked.record.backend == Backend::cpu ? "CPU" : "GPU")};
    for (std::size_t i = 0; i < s.notices.size(); ++i)
        report.sentences.push_back(fmt::format("{{notices/{}}}", i));
    if (s.sources > 0)
        report.sentences.emplace_back(
            "bounces are computed at {sources:#vertex|vertices}: those of the mesh, and added ones");
    report.sentences.emplace_back("{seconds:.3f} s: vertices {seconds_sources:.3f}, texels "
                                  "{seconds_texels:.3f}; {rays_per_second:.2fM} million rays/s");
    report.sentences.emplace_back(s.denoised
                                      ? "sampling noise of sky light: {sampling_error_relative_l2:.2f%}"
                                      : "sampling error of direct light: estimate "
                                        "{sampling_error_relative_l2:.3f%}");
    report.sentences.emplace_back("jumps of visibility across seams: {seam_before_rms:.4f} before the seams "
                                  "were closed, {seam_rms:.5f} after (root mean square)");
    report.sentences.emplace_back(
        "mean visibility of the sky: {mean_visibility:.1f%} (uniform sky, without bounces)");
    return report;
}

} // namespace prt::pipeline
