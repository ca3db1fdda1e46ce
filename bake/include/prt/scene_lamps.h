#pragma once

// Lamps of a scene for path tracing, implemented independently of the baker's: paths sample a light by one
// ray, and emissive surfaces by points on them and by hitting them. Experimental.

#include "prt/trace_scene.h"
#include "prt/transfer_layout.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Returns a part for each lamp of a scene without transfer: lights and emissive materials, by name.
std::vector<TransferTerm> lamps_of(const Scene& scene);

/// Samples the lamps of a scene. Thread-safe.
class SceneLamps {
public:
    /// Uses the lamps of the scene that are in `lamps`, by their name or as members, each multiplied by its
    /// strength, [lamps]. Other lamps are dark. Keeps a reference to `scene`. Throws `Error` if the number of
    /// strengths differs from the number of lamps.
    SceneLamps(const TraceScene& scene, std::span<const TransferTerm> lamps,
               std::span<const glm::vec3> strengths);

    bool has_lights() const { return !lights_.empty(); }
    bool has_surfaces() const { return !shining_.empty(); }

    /// Light of a sample without occlusion, divided by the probability of the sample.
    struct Sample {
        glm::vec3 towards{0, 1, 0}; ///< unit
        glm::vec3 way{0};           ///< vector to the point that the light comes from, or direction towards a
                                    ///< distant light
        float reach = 1;            ///< length of the shadow ray in lengths of `way`: 1, or infinite for
                                    ///< distant lights
        glm::vec3 irradiance{0};    ///< irradiance of a receiver that faces the light
        float density = 0;          ///< density of the direction over the sphere; 0: no other technique finds
                                    ///< this light

        /// Weight by the balance heuristic, if directions of density `other` find this light too.
        float balance(float other) const { return density > 0 ? density / (density + other) : 1.0f; }
    };
    /// Samples one of the punctual lights, mostly in proportion to their irradiance at `position`. The lights
    /// have no extent.
    Sample sample_light(const glm::vec3& position, float u) const;
    /// Samples a point on emissive surfaces in proportion to their power; the sample is black if `position`
    /// is behind a single-sided surface.
    Sample sample_surface(const glm::vec3& position, const glm::vec2& u) const;
    /// Share of the light of a sample that reaches `position` along the shadow ray.
    float open(const glm::vec3& position, const Sample& sample) const;

    /// Radiance that a point of a triangle emits towards the viewer, on its front or back.
    glm::vec3 radiance(const SurfacePoint& point, bool back) const;
    /// Density of `sample_surface` for a direction that hits the triangle at `distance` with this cosine to
    /// its normal.
    float density(std::uint32_t triangle, float distance, float cosine) const;

private:
    struct Light {
        std::uint32_t index; ///< index in Scene::lights
        glm::vec3 strength;
    };
    struct Shining {
        std::uint32_t triangle;
        double until; ///< sum of the powers up to and including this triangle
    };

    glm::vec3 strength_of(std::uint32_t triangle) const;
    Sample of_light(const Light& light, const glm::vec3& position) const;

    const TraceScene& scene_;
    std::vector<Light> lights_;
    std::vector<Shining> shining_;
    std::vector<glm::vec3> strengths_; ///< [materials] strengths
    std::vector<double> densities_;    ///< [triangles] density of a point by area; empty: nothing emits light
};

} // namespace prt
