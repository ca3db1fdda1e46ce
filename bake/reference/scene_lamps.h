#pragma once

// Lamps of a scene for path tracing, implemented independently of the baker. A path sends one shadow ray to a
// punctual light. It finds an emissive surface in two ways: by a shadow ray to a random point of the surface,
// and by a scattered ray that hits the surface. Experimental.

#include "bake/scene/trace_scene.h"
#include "prt/core/transfer_layout.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Returns one term of kind `lamp` for each different name of a light or an emissive material of `scene`,
/// with three channels and without `members`. Lights come first, then materials. Use it for a scene without
/// transfer; otherwise use TransferLayout::lamp_terms.
std::vector<TransferTerm> lamps_of(const Scene& scene);

/// Selects random samples of the light of a scene's lamps. Const functions are thread-safe. Colors are linear
/// Rec. 709. Positions are in metres, relative to Scene::origin.
class SceneLamps {
public:
    /// Selects the punctual lights and emissive materials of the scene that are members of `lamps`, and
    /// multiplies the light of each by the strength of its lamp: `strengths` [lamps], 1 as in the scene. All
    /// other lights and materials are dark. Keeps a reference to `scene`, not to the spans. Throws `Error` if
    /// the number of strengths differs from the number of lamps.
    SceneLamps(const TraceScene& scene, std::span<const TransferTerm> lamps,
               std::span<const glm::vec3> strengths);

    /// Returns whether any selected punctual light has a strength that is not zero.
    bool has_lights() const { return !lights_.empty(); }
    /// Returns whether any triangle with an area has an emissive material of a lamp whose strength is not
    /// zero. Required for `sample_surface`.
    bool has_surfaces() const { return !shining_.empty(); }

    /// A random sample of the light that lamps send to a position.
    struct Sample {
        glm::vec3 towards{0, 1, 0}; ///< unit direction from the position to the light
        glm::vec3 way{0}; ///< metres: vector from the position to the light, or to a point slightly in front
                          ///< of the emissive triangle; for a directional light the unit direction towards it
        float reach = 1;  ///< length of the shadow ray in lengths of `way`: 1, or infinity for
                          ///< directional lights
        /// Unoccluded light. For a punctual light: irradiance of a receiver whose normal is `towards`,
        /// divided by the probability of the light. For a point of a surface: emitted radiance times the
        /// coverage of the surface, divided by `density`. 0: a black sample, which sends no light.
        glm::vec3 irradiance{0};
        float density = 0; ///< probability density of `towards` per steradian; 0 for punctual lights, which
                           ///< scattered rays cannot hit

        /// Returns the weight of this sample by the balance heuristic, 0..1; 1 for punctual lights. `other`:
        /// density per steradian with which scattered rays have the direction `towards`.
        float balance(float other) const { return density > 0 ? density / (density + other) : 1.0f; }
    };
    /// Samples one of the punctual lights for a receiver at `position`. `u`: random number in [0, 1). The
    /// probability of a light is 20 % uniform and 80 % proportional to the luminance of its unoccluded
    /// irradiance at `position`. Returns a black sample if no light has an irradiance there.
    Sample sample_light(const glm::vec3& position, float u) const;
    /// Samples a point on the emissive triangles for a receiver at `position`. `u`: random point of the unit
    /// square. The density per area is proportional to the approximate luminance of a triangle. Returns a
    /// black sample if the point emits no light, or if `position` is behind a single-sided triangle. Requires
    /// `has_surfaces()`.
    Sample sample_surface(const glm::vec3& position, const glm::vec2& u) const;
    /// Returns the fraction of the light of `sample` that arrives at `position`, 0..1, according to a shadow
    /// ray. `position` must be the one for which `sample` was created, slightly off its surface. `sample`
    /// must not be black.
    float open(const glm::vec3& position, const Sample& sample) const;

    /// Returns the radiance that the front of `point`'s triangle emits at this point, or the back if `back`
    /// is true, times the strength of its lamp. 0 for a material that no selected lamp contains, and for the
    /// back of a single-sided material.
    glm::vec3 radiance(const SurfacePoint& point, bool back) const;
    /// Returns the density per steradian with which `sample_surface` selects the direction to a point of
    /// `triangle`; 0 if the triangle is not sampled. `distance`: metres from the receiver to the point.
    /// `cosine`: magnitude of the cosine between this direction and the normal of the triangle, 0..1.
    float density(std::uint32_t triangle, float distance, float cosine) const;

private:
    struct Light {
        std::uint32_t index; ///< index in Scene::lights
        glm::vec3 strength;  ///< strength of its lamp
    };
    struct Shining {
        std::uint32_t triangle;
        double until; ///< sum of the emitted powers of all entries up to and including this one
    };

    glm::vec3 strength_of(std::uint32_t triangle) const;
    Sample of_light(const Light& light, const glm::vec3& position) const;

    const TraceScene& scene_;
    std::vector<Light> lights_;
    std::vector<Shining> shining_;
    std::vector<glm::vec3> strengths_; ///< [materials] factor on the emission
    std::vector<double> densities_;    ///< [triangles] probability density per m²; empty: no triangle emits
                                       ///< light
};

} // namespace prt
