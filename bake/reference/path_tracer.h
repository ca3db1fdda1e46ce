#pragma once

// The reference renderer (docs/math.md, section 11): path tracing, without spherical harmonics and without
// interpolation between vertices.

#include "bake/reference/distant_light.h"
#include "bake/reference/scene_lamps.h"
#include "bake/scene/trace_scene.h"
#include "prt/bake/bake_options.h"
#include "prt/core/progress.h"
#include "prt/render/camera.h"

#include <array>
#include <cstdint>
#include <stop_token>
#include <vector>

namespace prt {

/// Settings of a path-traced picture.
struct PathTraceOptions {
    Camera camera;
    int width = 640, height = 360; ///< size of the picture in pixels, each at least 1
    /// Maximum number of bounces from surface to surface; 0: visible surfaces reflect direct light only.
    /// kEndlessBounces: no maximum, Russian roulette ends each path.
    int bounces = kEndlessBounces;
    /// True: multiply by the base color of visible surfaces; false: show exit radiance for albedo 1.
    bool textured = true;
    bool background = true; ///< true: show the environment behind the scene; false: show black there
    /// True: show the emission of visible surfaces that are lamps; false: show only the light that visible
    /// surfaces reflect.
    bool shining = true;
    /// True: trace rays through random points of each pixel; false: through the center of each pixel.
    bool antialiased = true;
    std::uint64_t seed = 0; ///< seed of the random paths

    friend bool operator==(const PathTraceOptions&, const PathTraceOptions&) = default;
};

/// Refines a picture pass by pass, with one path per pixel in each pass. Combines next-event estimation and
/// cosine sampling by the balance heuristic (Veach 1997), with Owen-scrambled Sobol points over the passes
/// (Burley 2020). Surfaces scatter as in the baker: Lambertian, cut out, blended or transmitting. Paths do
/// not enter media.
class PathTracer {
public:
    /// Keeps references to `scene`, `light` and `lamps`, and copies `options`. `lamps`: lamps whose light is
    /// added; null: all lamps are dark.
    PathTracer(const TraceScene& scene, const DistantLight& light, const PathTraceOptions& options,
               const SceneLamps* lamps = nullptr);

    /// Traces one more path for every pixel on `threads` threads (0: all). Throws `Cancelled` after a stop
    /// request, which is checked before each row. Rows that are complete then keep their new path, but the
    /// pass does not count, and the next pass repeats its random numbers.
    void add_pass(int threads = 0, std::stop_token stop = {});
    /// Returns the number of complete passes.
    int passes() const { return passes_; }

    /// Returns the mean of the paths of each pixel: radiance, linear Rec. 709, [height][width]; black before
    /// the first pass.
    Image image() const;
    /// Returns for each pixel whether the ray through its center hits a visible surface, [height][width]. The
    /// ray passes back sides of single-sided surfaces, and surfaces with an opacity below 0.5.
    std::vector<bool> surface_mask() const;

private:
    const TraceScene& scene_;
    const DistantLight& light_;
    const SceneLamps* lamps_;
    PathTraceOptions options_;
    CameraFrame frame_;
    int passes_ = 0;
    std::vector<glm::vec3> sums_; ///< [height][width]
    std::vector<int> counts_;     ///< [height]
};

/// A path-traced picture in two halves from independent random numbers, for the measures of
/// runtime/render/picture_error.h.
struct PathTracedPicture {
    std::array<Image, 2> halves; ///< radiance of each half, linear Rec. 709, [height][width]; the mean of the
                                 ///< halves is the picture
    std::vector<bool> surfaces;  ///< [height][width] true: the pixel shows a surface, as
                                 ///< PathTracer::surface_mask
};

/// Renders a picture with `paths` paths per pixel, rounded up to an even number, at least 2; half of the
/// paths belong to each of the two halves. The halves use the seeds 2 s and 2 s + 1, with s the seed of
/// `options`. Uses all threads of the machine. The other arguments are those of `PathTracer`. Throws
/// `Cancelled` after a stop request.
PathTracedPicture path_traced(const TraceScene& scene, const DistantLight& light,
                              const PathTraceOptions& options, int paths, const SceneLamps* lamps = nullptr,
                              const Progress& progress = {});

} // namespace prt
