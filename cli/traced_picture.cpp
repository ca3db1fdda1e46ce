// Path-traces pictures and their mean luminance.

#include "traced_picture.h"

#include "budget/budget_lights.h"
#include "prt/color.h"
#include "prt/receiver_colors.h"

#include <algorithm>

namespace prt::cli {
namespace {

DistantLight distant_light(const TracedLights& lights) {
    if (lights.environment.empty())
        return DistantLight({});
    std::vector<BudgetLight> read = budget_lights(
        {.files = {lights.environment}, .suns = {0}, .reading = lights.reading, .threads = lights.threads});
    return std::move(read.front().measured.all);
}

PathTraceOptions options_of(const Picture& picture) {
    PathTraceOptions options;
    options.camera = picture.camera;
    options.width = picture.width;
    options.height = picture.height;
    options.textured = picture.textured;
    options.background = picture.background.image != nullptr;
    return options;
}

PathTracedPicture trace(const TraceScene& scene, const TracedLights& lights, const PathTraceOptions& options,
                        int paths, const Progress& progress) {
    const DistantLight distant = distant_light(lights);
    const SceneLamps lamps(scene, lights.lamps, lights.strengths);
    return path_traced(scene, distant, options, paths, &lamps, progress);
}

} // namespace

PathTracedPicture traced_picture(const Picture& picture, const TraceScene& scene, const TracedLights& lights,
                                 int paths, const Progress& progress) {
    return trace(scene, lights, options_of(picture), paths, progress);
}

float traced_luminance(const Picture& picture, const TraceScene& scene, const TracedLights& lights) {
    constexpr int kMaxAcross = 48, kPaths = 16;
    PathTraceOptions options = options_of(picture);
    options.width = std::min(options.width, kMaxAcross);
    options.height = std::min(options.height, kMaxAcross);
    options.shining = false;
    const PathTracedPicture small = trace(scene, lights, options, kPaths, {});
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

} // namespace prt::cli
