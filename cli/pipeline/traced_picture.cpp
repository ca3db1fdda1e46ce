// Path-traces pictures and their mean luminance.

#include "cli/pipeline/traced_picture.h"

#include "cli/pipeline/budget_lights.h"
#include "compress/study/receiver_colors.h"
#include "prt/core/light.h"

#include <algorithm>

namespace prt::pipeline {
namespace {

PathTraceOptions options_of(const Picture& picture) {
    PathTraceOptions options;
    options.camera = picture.camera;
    options.width = picture.width;
    options.height = picture.height;
    options.textured = picture.textured;
    options.background = picture.background.image != nullptr;
    return options;
}

} // namespace

DistantLight distant_light(const Path& environment, LightOptions reading, int threads) {
    if (environment.empty())
        return DistantLight({});
    reading.window = Window::none;
    std::vector<ReferenceLight> read = budget_lights(
        {.files = {environment}, .suns = {0}, .reading = std::move(reading), .threads = threads});
    return std::move(read.front().all);
}

PathTracedPicture traced_picture(const Picture& picture, const TraceScene& scene, const DistantLight& sky,
                                 const SceneLamps& lamps, int paths, const Progress& progress) {
    return path_traced(scene, sky, options_of(picture), paths, &lamps, progress);
}

float traced_luminance(const Picture& picture, const TraceScene& scene, const DistantLight& sky,
                       const SceneLamps& lamps) {
    constexpr int kMaxAcross = 48, kPaths = 16;
    PathTraceOptions options = options_of(picture);
    options.width = std::min(options.width, kMaxAcross);
    options.height = std::min(options.height, kMaxAcross);
    options.shining = false;
    const PathTracedPicture small = path_traced(scene, sky, options, kPaths, &lamps);
    const Image mean = mean_of(small.halves);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < small.surfaces.size(); ++i)
        if (small.surfaces[i]) {
            sum += luminance(glm::dvec3(mean.pixels[i]));
            ++count;
        }
    return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.0f;
}

Image heat_image(int width, int height, std::span<const float> values) {
    Image image{width, height, {}};
    for (const float value : values)
        image.pixels.push_back(heat_color(static_cast<double>(value)));
    return image;
}

} // namespace prt::pipeline
