// Options for the measurement of light at receivers.

#include "cli/arguments/trace_arguments.h"

#include "cli/arguments/options.h"
#include "cli/arguments/suboptions.h"

namespace prt::cli {
namespace {

constexpr Choice<BakeMethod> kBakeMethods[] = {
    {"trace", BakeMethod::trace, "rays, traced by the processor of --device"},
    {"raster", BakeMethod::raster,
     "depth maps from --rays N directions, by OpenGL 4.5, for direct light of the sky\n"
     "  --device auto: a hardware GPU, else error; gpu: also a software driver; others: error"}};

} // namespace

void add_method(CLI::App* command, TracerChoice& tracer, const std::string& by_rays) {
    Suboptions("--method", names_of(kBakeMethods), "method that finds which directions are blocked",
               [&tracer](const std::string& name) { tracer.method = chosen("--method", kBakeMethods, name); })
        .detail(explained(kBakeMethods).substr(1) + "\n  " + by_rays +
                ": by rays, as with trace and --device auto")
        .whole_number("resolution", 16, 16384,
                      "texels along each side of a depth map, 16 to 16384; needs raster [1024]\n"
                      "  more than the GPU supports: an error",
                      [&tracer](int texels) { tracer.raster_resolution = texels; })
        .add(command)
        ->default_str("trace");
}

void check_method(const TracerChoice& tracer) {
    if (tracer.method == BakeMethod::trace && tracer.raster_resolution != TracerChoice{}.raster_resolution)
        throw CLI::ValidationError("--method", "resolution needs raster");
}

void add_target_error(CLI::App* command, CLI::Option* rays, std::optional<double>& target,
                      const std::string& details) {
    command
        ->add_option("--target-error", target,
                     "trace rays until direct light has at most this relative L2 noise\n"
                     "X: above 0; 0.01: 1 %; over the whole surface; sky only, not lamps; not with --rays\n"
                     "at most 2^24 rays for each vertex; default: the number of --rays" +
                         details)
        ->check(above_zero())
        ->excludes(rays);
}

} // namespace prt::cli
