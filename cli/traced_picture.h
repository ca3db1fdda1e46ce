#pragma once

// `prt render --path-trace`: the reference for what the runtime draws.

#include "inputs.h"
#include "prt/path_tracer.h"
#include "prt/picture.h"
#include "prt/picture_error.h"
#include "split_light.h"

#include <span>

namespace prt::cli {

/// Lights of a path-traced picture: the sky and its suns as the file has them, not as SH.
struct TracedLights {
    Path environment; ///< empty: the sky is dark
    LightOptions reading;
    std::vector<TransferPart> lamps = {};
    std::vector<glm::vec3> strengths = {}; ///< [lamps]
    int threads = 0;
};

/// Traces `paths` paths for each pixel of `picture` (its camera, size, and whether it is textured), with all
/// bounces. The background is seen where `picture` has one.
PathTracedPicture traced_picture(const Picture& picture, const TraceScene& scene, const TracedLights& lights,
                                 int paths, const Progress& progress);

/// Mean luminance of the light that visible surfaces reflect, by a small path-traced picture.
float traced_luminance(const Picture& picture, const TraceScene& scene, const TracedLights& lights);

/// Heat picture of an error map in 0..1, [height][width].
Image heat_image(int width, int height, std::span<const float> values);

} // namespace prt::cli
