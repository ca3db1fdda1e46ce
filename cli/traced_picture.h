#pragma once

// `prt render --path-trace`: the reference for pictures of the runtime.

#include "inputs.h"
#include "prt/path_tracer.h"
#include "prt/picture.h"
#include "prt/picture_error.h"
#include "split_light.h"

#include <span>

namespace prt::cli {

/// Lights of a path-traced picture: sky and suns from the file, not as SH.
struct TracedLights {
    Path environment; ///< empty: the sky is dark
    LightOptions reading;
    std::vector<TransferTerm> lamps = {};
    std::vector<glm::vec3> strengths = {}; ///< [lamps]
    int threads = 0;
};

/// Traces `paths` paths per pixel of `picture` (with its camera, size and `textured`), with all bounces. The
/// background is visible if `picture` has one.
PathTracedPicture traced_picture(const Picture& picture, const TraceScene& scene, const TracedLights& lights,
                                 int paths, const Progress& progress);

/// Returns the mean luminance of the light that visible surfaces reflect, from a small path-traced picture.
float traced_luminance(const Picture& picture, const TraceScene& scene, const TracedLights& lights);

/// Returns a heat picture of an error map in 0..1, [height][width].
Image heat_image(int width, int height, std::span<const float> values);

} // namespace prt::cli
