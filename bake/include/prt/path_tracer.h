#pragma once

// The reference renderer (docs/math.md, section 11): path tracing, without spherical harmonics and without
// interpolation between vertices.

#include "prt/bake.h"
#include "prt/camera.h"
#include "prt/distant_light.h"
#include "prt/scene_lamps.h"
#include "prt/trace_scene.h"

#include <array>
#include <cstdint>
#include <stop_token>
#include <vector>

namespace prt {

/// Settings of a path-traced picture.
struct PathTraceOptions {
    Camera camera;
    int width = 640, height = 360;
    int bounces = kEndlessBounces; ///< maximum number of bounces between surfaces; kEndlessBounces: Russian
                                   ///< roulette ends the path
    /// True: multiply by the base color of visible surfaces; false: show exit radiance for albedo 1.
    bool textured = true;
    bool background = true; ///< true: show the environment behind the scene; false: black
    /// True: show the emission of surfaces; false: show only the light that they reflect.
    bool shining = true;
    /// True: rays through random points of each pixel; false: through its center.
    bool antialiased = true;
    std::uint64_t seed = 0;

    friend bool operator==(const PathTraceOptions&, const PathTraceOptions&) = default;
};

/// Refines a picture pass by pass, with one path per pixel in each pass. Combines next-event estimation and
/// cosine sampling by the balance heuristic (Veach 1997), with Owen-scrambled Sobol points over the passes
/// (Burley 2020). Surfaces scatter as in the baker: Lambertian, cut out, blended or transmitting; paths do
/// not enter media.
class PathTracer {
public:
    /// Keeps references to all arguments except the options. `lamps`: lamps whose light is added; null: all
    /// lamps are dark.
    PathTracer(const TraceScene& scene, const DistantLight& light, const PathTraceOptions& options,
               const SceneLamps* lamps = nullptr);

    /// Traces one more path for every pixel on `threads` threads (0: all). A stop request is checked before
    /// each row: `Cancelled` is then thrown, and rows that are complete keep their new path.
    void add_pass(int threads = 0, std::stop_token stop = {});
    int passes() const { return passes_; }

    /// Returns the mean of all passes: linear radiance, [height][width].
    Image image() const;
    /// Returns whether the ray through the center of each pixel hits a visible surface, [height][width].
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

/// A path-traced picture in two independent halves, for the measures of prt/picture_error.h.
struct PathTracedPicture {
    std::array<Image, 2> halves; ///< [height][width]
    std::vector<bool> surfaces;  ///< see `PathTracer::surface_mask`
};

/// Renders a picture with `paths` paths per pixel, rounded up to an even number. Other arguments are those of
/// `PathTracer`. Throws `Cancelled` after a stop request.
PathTracedPicture path_traced(const TraceScene& scene, const DistantLight& light,
                              const PathTraceOptions& options, int paths, const SceneLamps* lamps = nullptr,
                              const Progress& progress = {});

} // namespace prt
