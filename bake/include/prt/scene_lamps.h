#pragma once

// Lamps of a scene for path tracing, implemented independently of the baker. Paths sample a punctual light by
// one ray. They sample emissive surfaces by rays to points on them, and by rays that hit them. Experimental.

#include "prt/trace_scene.h"
#include "prt/transfer_layout.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Returns the lamps of a scene that has no transfer: its lights and emissive materials. Lamps of one
/// name share a term.
std::vector<TransferTerm> lamps_of(const Scene& scene);

/// Samples the lamps of a scene. Thread-safe.
class SceneLamps {
public:
    /// Selects the lights and materials of the scene that are members of `lamps` and multiplies each by the
    /// strength of its lamp, `strengths` [lamps]. All others are dark. Keeps a reference to `scene`. Throws
    /// `Error` if the number of strengths differs from the number of lamps.
    SceneLamps(const TraceScene& scene, std::span<const TransferTerm> lamps,
               std::span<const glm::vec3> strengths);

    bool has_lights() const { return !lights_.empty(); }
    bool has_surfaces() const { return !shining_.empty(); }

    /// A sample of the light of lamps.
    struct Sample {
        glm::vec3 towards{0, 1, 0}; ///< unit
        glm::vec3 way{0}; ///< vector to the point that emits the light, or direction towards a distant light
        float reach = 1;  ///< length of the shadow ray in lengths of `way`: 1, or infinite for
                          ///< distant lights
        glm::vec3 irradiance{0}; ///< unoccluded irradiance of a receiver that faces the light, divided by the
                                 ///< probability of the sample
        float density = 0; ///< probability density of the direction over the sphere; 0: other techniques
                           ///< cannot sample this light

        /// Returns the weight of the sample by the balance heuristic. `other`: probability density of the
        /// other technique that also samples this light.
        float balance(float other) const { return density > 0 ? density / (density + other) : 1.0f; }
    };
    /// Samples one of the punctual lights, with a probability that is mostly proportional to its irradiance
    /// at `position`. The lights have no extent.
    Sample sample_light(const glm::vec3& position, float u) const;
    /// Samples a point on emissive surfaces in proportion to their power; the sample is black if `position`
    /// is behind a single-sided surface.
    Sample sample_surface(const glm::vec3& position, const glm::vec2& u) const;
    /// Returns the share of the light of a sample that reaches `position` along the shadow ray, 0..1.
    float open(const glm::vec3& position, const Sample& sample) const;

    /// Returns the radiance that a point emits on the front of its triangle, or on the back if `back`.
    glm::vec3 radiance(const SurfacePoint& point, bool back) const;
    /// Returns the probability density of `sample_surface` over the sphere for a direction that hits
    /// `triangle` at `distance`. `cosine`: cosine of the angle to its normal.
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
    std::vector<glm::vec3> strengths_; ///< [materials] factors on emission
    std::vector<double> densities_;    ///< [triangles] density of a point by area; empty: nothing emits light
};

} // namespace prt
