#pragma once

// Paths from what is seen to distant light: next-event estimation and cosine sampling, combined by the
// balance heuristic (E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997).

#include "pictures/lit_side.h"
#include "prt/distant_light.h"
#include "prt/scene_lamps.h"
#include "prt/trace_scene.h"
#include "trace/sample_sequence.h"

#include <glm/vec2.hpp>

#include <optional>

namespace prt {

/// The points of one path. Every pair of dimensions is a Sobol net over the passes, scrambled and put in an
/// order of its own (B. Burley, "Practical Hash-based Owen Scrambling", JCGT 2020).
class PathSamples {
public:
    PathSamples(std::uint32_t seed, std::uint32_t index) : seed_(seed), reversed_(reverse_bits(index)) {}

    glm::vec2 next();

private:
    std::uint32_t seed_, reversed_, pair_ = 0;
};

/// A direction about unit `normal` with density cos / pi, of a point `u` of the unit square.
glm::vec3 cosine_direction(const glm::vec3& normal, const glm::vec2& u);

struct SurfaceHit {
    float distance;
    SurfacePoint point;
    LitSide side;  ///< that was met
    bool scatters; ///< that side of it
    bool back;     ///< of the triangle
};

struct LightPath {
    Ray ray; ///< that comes next
    glm::vec3 radiance{0}, throughput{1};
    std::optional<float> density = {}; ///< of the ray's direction by the cosine; none: the camera's own ray
    int vertices = 0;

    bool from_camera() const { return !density; }
};

/// What arrives at the first surface of a path, and what arrives at the others: the same, unless a renderer
/// adds some of it at the first by itself.
struct PathLight {
    const DistantLight &first, &bounced;
    const SceneLamps* lamps = nullptr; ///< none: they are dark
};

struct PathRules {
    int bounces; ///< between surfaces; kEndlessBounces: until roulette ends the path
    /// Multiply by the base color of what the camera sees; else exit radiance for albedo 1.
    bool textured;
    bool background;   ///< distant light behind the scene is seen
    bool lamps = true; ///< surfaces that shine are seen to
};

/// What paths share.
struct LightPaths {
    const TraceScene& scene;
    PathLight light;
    PathRules rules;

    std::optional<SurfaceHit> nearest(const Ray& ray) const;
    /// Goes on along the ray of `path` until it ends: true where it does so in distant light, which the ray
    /// then points to.
    bool follow(LightPath& path, PathSamples& samples) const;
    /// Lights what is met and chooses the next ray; false where the path ends.
    bool scatter(const SurfaceHit& hit, LightPath& path, PathSamples& samples) const;

private:
    void add_background(LightPath& path) const;
    std::optional<LitSide> choose_side(const SurfaceHit& hit, LightPath& path, PathSamples& samples) const;
    void add_direct_light(const LitSide& side, LightPath& path, PathSamples& samples) const;
    void add_lamp_light(const LitSide& side, LightPath& path, PathSamples& samples) const;
    void add_emission(const SurfaceHit& hit, LightPath& path) const;
    bool bounce(const LitSide& side, LightPath& path, PathSamples& samples) const;
};

} // namespace prt
