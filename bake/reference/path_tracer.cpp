// Traces paths through the pixels of a picture.

#include "bake/reference/path_tracer.h"

#include "bake/reference/light_paths.h"
#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

glm::vec3 unit_direction(const CameraFrame& frame, const PathTraceOptions& options, double x, double y) {
    return glm::vec3(glm::normalize(view_direction(frame, options.width, options.height, x, y)));
}

LightPaths paths_of(const TraceScene& scene, const PathLight& light, const PathTraceOptions& options) {
    return {scene, light, {options.bounces, options.textured, options.background, options.shining}};
}

} // namespace

PathTracer::PathTracer(const TraceScene& scene, const DistantLight& light, const PathTraceOptions& options,
                       const SceneLamps* lamps)
    : scene_(scene), light_(light), lamps_(lamps), options_(options), frame_(camera_frame(options.camera)),
      sums_(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height)),
      counts_(static_cast<std::size_t>(options.height)) {}

void PathTracer::add_pass(int threads, std::stop_token stop) {
    const LightPaths paths = paths_of(scene_, {light_, light_, lamps_}, options_);
    const auto pass = static_cast<std::uint32_t>(passes_);
    parallel_for(counts_.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            if (stop.stop_requested())
                throw Cancelled();
            for (int x = 0; x < options_.width; ++x) {
                const std::size_t i =
                    y * static_cast<std::size_t>(options_.width) + static_cast<std::size_t>(x);
                PathSamples samples(receiver_seed(static_cast<std::uint32_t>(i), options_.seed), pass);
                const glm::dvec2 at = options_.antialiased ? glm::dvec2(samples.next()) : glm::dvec2(0.5);
                const glm::vec3 view =
                    unit_direction(frame_, options_, x + at.x, static_cast<double>(y) + at.y);
                LightPath path{{options_.camera.position, view}};
                paths.follow(path, samples);
                sums_[i] += path.radiance;
            }
            ++counts_[y];
        }
    });
    ++passes_;
}

Image PathTracer::image() const {
    Image image{options_.width, options_.height, sums_};
    for (int y = 0; y < options_.height; ++y)
        for (int x = 0; x < options_.width; ++x)
            image.at(x, y) /= static_cast<float>(std::max(1, counts_[static_cast<std::size_t>(y)]));
    return image;
}

std::vector<bool> PathTracer::surface_mask() const {
    const LightPaths paths = paths_of(scene_, {light_, light_}, options_);
    std::vector<bool> mask;
    for (int y = 0; y < options_.height; ++y)
        for (int x = 0; x < options_.width; ++x) {
            Ray ray{options_.camera.position, unit_direction(frame_, options_, x + 0.5, y + 0.5)};
            auto hit = paths.nearest(ray);
            while (hit && (!hit->scatters || scene_.surfaces().coverage(hit->point) < 0.5f)) {
                ray.from = std::nextafter(hit->distance, std::numeric_limits<float>::infinity());
                hit = paths.nearest(ray);
            }
            mask.push_back(hit.has_value());
        }
    return mask;
}

PathTracedPicture path_traced(const TraceScene& scene, const DistantLight& light,
                              const PathTraceOptions& options, int paths, const SceneLamps* lamps,
                              const Progress& progress) {
    const int passes = std::max(1, (paths + 1) / 2);
    PathTracedPicture result;
    for (std::size_t half = 0; half < 2; ++half) {
        PathTraceOptions own = options;
        own.seed = 2 * options.seed + half;
        PathTracer tracer(scene, light, own, lamps);
        for (int pass = 0; pass < passes; ++pass) {
            tracer.add_pass(0, progress.stop);
            progress.update((static_cast<double>(half) * passes + pass + 1) / (2.0 * passes));
        }
        result.halves[half] = tracer.image();
        if (half == 0)
            result.surfaces = tracer.surface_mask();
    }
    return result;
}

} // namespace prt
