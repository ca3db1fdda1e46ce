// Parses the options of volumes.

#include "cli/arguments/volume_arguments.h"

#include "cli/arguments/options.h"
#include "cli/arguments/suboptions.h"
#include "prt/core/error.h"

#include <fmt/core.h>

#include <cmath>

namespace prt::cli {
namespace {

VolumeRequest::WorldBounds parse_bounds(const std::string& text) {
    VolumeRequest::WorldBounds b;
    int used = 0;
    const int numbers = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%n", &b.least.x, &b.least.y,
                                    &b.least.z, &b.most.x, &b.most.y, &b.most.z, &used);
    bool finite = true;
    for (int a = 0; a < 3; ++a)
        finite = finite && std::isfinite(b.least[a]) && std::isfinite(b.most[a]);
    if (numbers != 6 || static_cast<std::size_t>(used) != text.size() || !finite)
        throw CLI::ValidationError("--volume", "bounds=" + text + ": expected x0,y0,z0,x1,y1,z1 in metres");
    return b;
}

void check_one(bool other) {
    if (other)
        throw CLI::ValidationError("--volume", "METRES and probes cannot be combined");
}

} // namespace

CLI::Option* add_volume(CLI::App* command, VolumeRequest& arguments) {
    VolumeOptions& volume = arguments.volume;
    return Suboptions(
               "--volume", "METRES", "also bake probes at this distance, for moving objects; default: none",
               [&volume](const std::string& text) {
                   const std::optional<double> metres = real_number(text);
                   if (!metres || !(*metres >= 1e-9 && *metres <= static_cast<double>(kFarthestVertex)))
                       throw CLI::ValidationError("--volume", "'" + text + "' is not a distance in metres");
                   check_one(volume.probes > 0);
                   volume.spacing = *metres;
               })
        .detail("METRES: distance between probes near surfaces, 1e-9 to 1e9; it is larger in open space\n"
                "with --high-poly, probes receive the light of that model")
        .whole_number("probes", 125, 1 << 28,
                      "instead of METRES, as --volume probes=4000: at most N probes, 125 to 2^28",
                      [&volume](int count) {
                          check_one(volume.spacing > 0);
                          volume.probes = static_cast<std::size_t>(count);
                      })
        .number("error", 0, 0.99,
                "split cells, down to METRES / 4, until the relative L2 error is <= X [0: no split]\n"
                "  0 to 0.99; needs METRES; error of interpolation between probes, over the whole volume",
                [&volume](double error) { volume.error = error; })
        .whole_number("order", 2, kMaxIncidentOrder,
                      "SH order of the light that arrives at a probe, 2 to 4 [3]",
                      [&volume](int order) { volume.order = order; })
        .whole_number("rays", 1, kMaxRays, "rays per probe, 1 to 2^24 [--rays]",
                      [&volume](int rays) { volume.rays = rays; })
        .number("fit", 0, 100,
                fmt::format("fit probes to X points per cell; 0: no fit [1 for at least {} rays, else 0]\n"
                            "  0 to 100, mean number of random points where light is measured",
                            kRaysWorthAFit),
                [&volume](double points) { volume.fit_points = points; })
        .key("bounds", "x0,y0,z0,x1,y1,z1",
             "corners of the volume, world space, metres [box of the scene]\n"
             "  x0 < x1, y0 < y1, z0 < z1",
             [&arguments](const std::string& text) { arguments.bounds = parse_bounds(text); })
        .add(command);
}

void check_volume(const VolumeRequest& arguments, const CLI::Option* option) {
    if (!arguments.given() && option->count() > 0)
        throw Error(
            "--volume needs a distance or a number of probes, as --volume 0.5 or --volume probes=4000");
}

} // namespace prt::cli
