#pragma once

// The reference (docs/math.md, section 11): what the camera sees, by path tracing, without spherical
// harmonics and without interpolation between vertices.

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

struct PathTraceOptions {
    Camera camera;
    int width = 640, height = 360;
    int bounces = kEndlessBounces; ///< between surfaces; endless: until roulette ends the path
    /// Multiply by the base color of what the camera sees; else exit radiance for albedo 1.
    bool textured = true;
    bool background = true; ///< show the environment behind the scene; else black
    bool shining = true;    ///< show the emission of surfaces; else only light that they reflect
    /// Rays through random points of each pixel; else through its center.
    bool antialiased = true;
    std::uint64_t seed = 0;

    friend bool operator==(const PathTraceOptions&, const PathTraceOptions&) = default;
};

/// Refines a picture pass by pass, a path per pixel each: next-event estimation and cosine sampling combined
/// by the balance heuristic (Veach 1997), Owen-scrambled Sobol points over the passes (Burley 2020).
/// Surfaces are as the baker takes them: Lambertian, cut out, blended, transmitting; media are not entered.
class PathTracer {
public:
    /// Keeps references to all but the options. `lamps` shine beside the light; none: all are dark.
    PathTracer(const TraceScene& scene, const DistantLight& light, const PathTraceOptions& options,
               const SceneLamps* lamps = nullptr);

    /// Traces one path more for every pixel. Throws `Cancelled` within a row when asked to stop; the rows
    /// that are done count. `threads` 0: all.
    void add_pass(int threads = 0, std::stop_token stop = {});
    int passes() const { return passes_; }

    /// The mean so far: linear radiance, [height][width].
    Image image() const;
    /// Whether the ray through the center of each pixel meets a surface that the camera sees. [height][width]
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
    std::vector<bool> surfaces;  ///< as `PathTracer::surface_mask`
};

/// Traces `paths` paths for each pixel, rounded up to an even number. `scene`, `light` and `lamps` as for
/// `PathTracer`. Throws `Cancelled`.
PathTracedPicture path_traced(const TraceScene& scene, const DistantLight& light,
                              const PathTraceOptions& options, int paths, const SceneLamps* lamps = nullptr,
                              const Progress& progress = {});

} // namespace prt
