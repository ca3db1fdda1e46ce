// Reports the bake and the compression of a volume.

#include "cli/report/volume_report.h"

#include "cli/report/transfer_words.h"

#include <fmt/core.h>

namespace prt::pipeline {

Json grid_figures(const VolumeGrid& grid, std::size_t probes, int order) {
    return {{"probes", probes},
            {"bricks", grid.bricks.size()},
            {"spacing_metres", grid.spacing},
            {"incident_order", order}};
}

std::string grid_sentence(const std::string& key) {
    return fmt::format("volume: {{{0}/probes:#probe}} in {{{0}/bricks:#brick}}, finest spacing "
                       "{{{0}/spacing_metres:.3g}} m, incident light of order {{{0}/incident_order}}",
                       key);
}

void add_volume_bake(const VolumeBake& bake, Report& report) {
    const VolumeStatistics& s = bake.statistics;
    Json figures = grid_figures(bake.volume.grid, s.probes.all, bake.volume.order);
    figures.update(Json{{"probes_moved", s.probes.moved},
                        {"probes_inside_geometry", s.probes.invalid},
                        {"probes_hanging", s.probes.hanging},
                        {"fit_points", s.probes.fit_points},
                        {"error_between_probes_before", s.fit_before},
                        {"error_between_probes", s.fit_after},
                        {"rays", s.rays},
                        {"device", s.device},
                        {"seconds", s.seconds.all},
                        {"seconds_sources", s.seconds.sources},
                        {"seconds_probes", s.seconds.probes},
                        {"seconds_fit", s.seconds.fit},
                        {"rays_per_second", s.rays_per_second()}});
    add_figures(report, {{"volume", figures}});
    report.sentences.push_back(grid_sentence("volume"));
    report.sentences.emplace_back("  {volume/probes_moved:#probe} moved away from surfaces; "
                                  "{volume/probes_inside_geometry} inside geometry, filled from neighbours");
    if (s.probes.fit_points > 0)
        report.sentences.emplace_back(
            "  interpolation error at {volume/fit_points:#point} between probes (relative L2 of all "
            "coefficients): {volume/error_between_probes_before:.1f%} before the fit, "
            "{volume/error_between_probes:.1f%} after");
    report.sentences.emplace_back("  {volume/seconds:.3f} s: vertices {volume/seconds_sources:.3f}, probes "
                                  "{volume/seconds_probes:.3f}, fit {volume/seconds_fit:.3f}; "
                                  "{volume/rays_per_second:.2fM} million rays/s");
}

void add_volume_compression(const CompressStatistics& statistics, const CompressedVolume& volume,
                            Report& report) {
    const std::size_t probes = volume.visibility.size();
    Json figures = grid_figures(volume.grid, probes, volume.order);
    figures.update(Json{{"clusters", statistics.clusters},
                        {"components_mean", statistics.mean_components},
                        {"bytes_bound_per_probe", statistics.bytes_per_receiver},
                        {"bytes_per_probe_with_bases", statistics.bytes_with_bases(probes)},
                        {"visibility_bytes_per_probe", sizeof(ProbeVisibility)},
                        {"expected_error", statistics.lit_rms},
                        {"seconds", statistics.seconds}});
    add_figures(report, {{"volume", figures}});
    report.sentences.push_back(grid_sentence("volume"));
    report.sentences.emplace_back(
        "  {volume/clusters:#cluster} x {volume/components_mean:.2f} components, "
        "{volume/bytes_bound_per_probe} bytes per probe, {volume/bytes_per_probe_with_bases:.2f} with the "
        "bases, plus {volume/visibility_bytes_per_probe} for visibility distances; expected error of "
        "incident light {volume/expected_error:.2f%}; {volume/seconds:.2f} s");
}

} // namespace prt::pipeline
