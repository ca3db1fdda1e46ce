#include "commands.h"

#include "inputs.h"
#include "prt/error.h"
#include "prt/sh.h"
#include "prt/stopwatch.h"
#include "report.h"

#include <fmt/core.h>

namespace prt::cli {
namespace {

const char* layout_name(EnvironmentLayout layout) {
    switch (layout) {
    case EnvironmentLayout::cube:
        return "cube";
    case EnvironmentLayout::cube_faces:
        return "cube-faces";
    case EnvironmentLayout::angular:
        return "angular";
    case EnvironmentLayout::lat_long:
        break;
    }
    return "lat-long";
}

} // namespace

void run(const ProjectArguments& a, Interrupt& interrupt) {
    check_order(a.order);
    const Stopwatch stopwatch;
    const LoadedLight loaded = load_light(a.environment, a.order, a.light_options, a.threads);
    const double seconds = stopwatch.seconds();
    write_json(light_json(loaded.light), a.output, interrupt);

    const glm::vec3 mean = loaded.light.coefficients[0] * static_cast<float>(detail::kLegendre.sectoral[0]);
    fmt::print("{}: order {}, mean radiance {:.4g} {:.4g} {:.4g}\n", a.output.string(), a.order, mean.r,
               mean.g, mean.b);
    Json report = {{"output", a.output.string()},
                   {"order", a.order},
                   {"mean_radiance", {mean.r, mean.g, mean.b}},
                   {"seconds", seconds}};
    if (loaded.environment) {
        const Environment& environment = *loaded.environment;
        const char* layout = layout_name(environment.layout);
        fmt::print("  from a {} image of {} x {}\n", layout, environment.image.width,
                   environment.image.height);
        report["layout"] = layout;
        report["width_pixels"] = environment.image.width;
        report["height_pixels"] = environment.image.height;
    }
    write_json(report, a.json, interrupt);
}

} // namespace prt::cli
