#pragma once

// Error, bytes and time of every way to light a scene, against path tracing.

#include "pictures/model.h"
#include "pictures/picture_kind.h"

#include "prt/core/environment.h"
#include "prt/core/light.h"
#include "prt/gl/gl_context.h"
#include "prt/image/image_file.h"
#include "runtime/render/picture_error.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace comparison {

struct Options {
    int width = 640, height = 360;
    int passes = 64; ///< paths per pixel of each half of the reference
    int bake_rays = 4096;
    int lightmap_size = 512;  ///< texels along each side
    double frame_seconds = 1; ///< to measure frame times for
};

struct Sky {
    std::string name;
    prt::Image lat_long;
    prt::Light light; ///< light of the maximum order
    /// Its brightest sun, if it has one; `rest` is the sky without it.
    std::vector<prt::Sun> suns = {};
    prt::Light rest = {}; ///< order 6
};
Sky load_sky(const std::filesystem::path& path);

struct Row {
    std::string method;
    double bytes_per_vertex = 0;
    std::vector<prt::PictureError> errors; ///< [skies]; their maps are empty
    /// Time to draw a frame, and time per change of the light; unset if the row is not a frame of the viewer.
    std::optional<double> frame_milliseconds = {}, relight_milliseconds = {};
    prt::Image picture; ///< under the first sky, linear
};

struct SceneResult {
    std::string name;
    std::size_t vertices = 0, triangles = 0;
    int channels = 1;
    std::string device; ///< that drew
    std::vector<Row> rows;
    prt::Image reference; ///< under the first sky
    std::vector<bool> surfaces;
    float exposure = 1;                  ///< for the first sky
    std::vector<double> reference_noise; ///< [skies] relative L2 of the mean of both references
};

/// Measures everything for one scene; the base color is 1 in all pictures. `say` receives the name of each
/// next step.
SceneResult measure(const std::filesystem::path& scene, const std::vector<Sky>& skies, const Options& options,
                    const prt::GlContext& context, const std::function<void(const std::string&)>& say);

} // namespace comparison
