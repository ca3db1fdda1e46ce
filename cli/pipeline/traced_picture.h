#pragma once

// `prt render --path-trace`: the reference for pictures of the runtime.

#include "bake/reference/path_tracer.h"
#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/model.h"
#include "prt/render/picture.h"
#include "runtime/render/picture_error.h"

#include <span>

namespace prt::pipeline {

/// Loads sky and suns of an environment map or a light file for path tracing, not as SH and without a window.
/// Returns a dark sky if `environment` is empty.
DistantLight distant_light(const Path& environment, LightOptions reading, int threads);

/// Traces `paths` paths per pixel of `picture` (with its camera, size and `textured`), with all bounces. The
/// background is visible if `picture` has one.
PathTracedPicture traced_picture(const Picture& picture, const TraceScene& scene, const DistantLight& sky,
                                 const SceneLamps& lamps, int paths, const Progress& progress);

/// Returns the mean luminance of the light that visible surfaces reflect, from a small path-traced picture.
float traced_luminance(const Picture& picture, const TraceScene& scene, const DistantLight& sky,
                       const SceneLamps& lamps);

/// Returns a heat picture of an error map in 0..1, [height][width].
Image heat_image(int width, int height, std::span<const float> values);

} // namespace prt::pipeline
