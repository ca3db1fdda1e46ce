// Parses the options of volumes.

#include "volume_arguments.h"

#include "options.h"
#include "prt/support/error.h"

#include <fmt/core.h>

#include <cmath>

namespace prt::cli {
namespace {

VolumeArguments::WorldBounds parse_bounds(const std::string& text) {
    VolumeArguments::WorldBounds b;
    int used = 0;
    const int numbers = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%n", &b.least.x, &b.least.y,
                                    &b.least.z, &b.most.x, &b.most.y, &b.most.z, &used);
    bool finite = true;
    for (int a = 0; a < 3; ++a)
        finite = finite && std::isfinite(b.least[a]) && std::isfinite(b.most[a]);
    if (numbers != 6 || static_cast<std::size_t>(used) != text.size() || !finite)
        throw CLI::ValidationError("--volume-bounds", "'" + text + "' is not x0,y0,z0,x1,y1,z1 in metres");
    return b;
}

} // namespace

void add_volume(CLI::App* command, VolumeArguments& arguments) {
    VolumeOptions& volume = arguments.volume;
    CLI::Option* spacing =
        command
            ->add_option("--volume", volume.spacing,
                         "also bake probes in free space, which light what moves: so many metres apart near "
                         "surfaces, further in the open")
            ->check(real_in(1e-9, kFarthestVertex))
            ->type_name("METRES");
    command->add_option("--volume-probes", volume.probes, "the same, as close as so many probes allow")
        ->check(CLI::Range(std::size_t{125}, std::size_t{1} << 28))
        ->excludes(spacing);
    command
        ->add_option(
            "--volume-error", volume.error,
            "split cells where light between probes errs most, down to a quarter, until coefficients "
            "of transfer err by so much over all (relative L2, low bands count more; light itself errs by "
            "about twice that under skies with bright parts); 0: no cell")
        ->capture_default_str()
        ->check(real_in(0, 0.99));
    command
        ->add_option_function<std::string>(
            "--volume-bounds",
            [&arguments](const std::string& text) { arguments.bounds = parse_bounds(text); },
            "box that probes fill, in the world; otherwise that of the scene")
        ->type_name("x0,y0,z0,x1,y1,z1");
    command
        ->add_option("--volume-order", volume.order, "SH bands of the light that comes in at a probe, 2 to 4")
        ->capture_default_str()
        ->check(CLI::Range(2, kMaxIncidentOrder));
    command
        ->add_option("--volume-fit", volume.fit_points,
                     fmt::format("points for each probe where light between probes is measured, which probes "
                                 "are then fitted to; 0: none; otherwise 1 from {} rays on",
                                 kRaysWorthAFit))
        ->check(real_in(0, 100));
}

void check_volume(const VolumeArguments& arguments) {
    const VolumeOptions usual;
    const VolumeOptions& volume = arguments.volume;
    if (!arguments.given() && (arguments.bounds || volume.order != usual.order ||
                               volume.fit_points != usual.fit_points || volume.error != usual.error))
        throw Error("--volume-bounds, --volume-error, --volume-order and --volume-fit are of volumes: say "
                    "--volume or --volume-probes, too");
}

VolumeOptions volume_options(const VolumeArguments& arguments, const Scene& scene) {
    VolumeOptions volume = arguments.volume;
    if (arguments.bounds)
        volume.bounds = {glm::vec3(arguments.bounds->least - scene.origin),
                         glm::vec3(arguments.bounds->most - scene.origin)};
    return volume;
}

} // namespace prt::cli
