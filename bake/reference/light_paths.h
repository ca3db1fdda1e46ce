#pragma once

// Paths from visible surfaces to distant light: next-event estimation and cosine sampling, combined by the
// balance heuristic (E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997).

#include "bake/reference/distant_light.h"
#include "bake/reference/scene_lamps.h"
#include "bake/scene/lit_side.h"
#include "bake/scene/trace_scene.h"
#include "bake/trace/sample_sequence.h"

#include <glm/vec2.hpp>

#include <optional>

namespace prt {

/// Random points of one path. Every pair of dimensions is a Sobol net over the passes, with an independent
/// scramble and order (B. Burley, "Practical Hash-based Owen Scrambling", JCGT 2020).
class PathSamples {
public:
    PathSamples(std::uint32_t seed, std::uint32_t index) : seed_(seed), reversed_(reverse_bits(index)) {}

    glm::vec2 next();

private:
    std::uint32_t seed_, reversed_, pair_ = 0;
};

/// Returns a direction about unit `normal` with density cos / pi, for a point `u` of the unit square.
glm::vec3 cosine_direction(const glm::vec3& normal, const glm::vec2& u);

struct SurfaceHit {
    float distance;
    SurfacePoint point;
    LitSide side;  ///< side that the ray hit
    bool scatters; ///< this side scatters light
    bool back;     ///< back of the triangle
};

struct LightPath {
    Ray ray; ///< next ray
    glm::vec3 radiance{0}, throughput{1};
    std::optional<float> density = {}; ///< density of the ray's direction by cosine sampling; empty: a camera
                                       ///< ray
    int vertices = 0;

    bool from_camera() const { return !density; }
};

/// Light that arrives at the first surface of a path and at the others. They are equal unless a renderer adds
/// a part of the light at the first surface itself.
struct PathLight {
    const DistantLight &first, &bounced;
    const SceneLamps* lamps = nullptr; ///< null: lamps are dark
};

struct PathRules {
    int bounces; ///< bounces between surfaces; kEndlessBounces: until Russian roulette ends the path
    /// Multiply by the base color of visible surfaces; otherwise compute exit radiance for albedo 1.
    bool textured;
    bool background;   ///< distant light is visible behind the scene
    bool lamps = true; ///< emission of surfaces is visible to the camera
};

/// Data that all paths share.
struct LightPaths {
    const TraceScene& scene;
    PathLight light;
    PathRules rules;

    std::optional<SurfaceHit> nearest(const Ray& ray) const;
    /// Continues `path` until it ends. Returns true if it ends in distant light; its ray then points to that
    /// light.
    bool follow(LightPath& path, PathSamples& samples) const;
    /// Adds light at the hit and chooses the next ray. Returns false if the path ends.
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
