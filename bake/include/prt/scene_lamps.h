#pragma once

// Lamps of a scene as paths find them, apart from the baker's: lights by a ray to one of them, surfaces that
// shine by points of theirs and by being met. Experimental.

#include "prt/trace_scene.h"
#include "prt/transfer_layout.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// A part for each lamp of a scene that holds no transfer: lights and shining materials, by name.
std::vector<TransferPart> lamps_of(const Scene& scene);

/// Thread-safe.
class SceneLamps {
public:
    /// Those of the scene that are in `lamps`, by the name of theirs, or as members; each as bright as its
    /// strength, [lamps]. Others are dark. Keeps a reference to `scene`. Throws `Error` where there are not
    /// as many strengths.
    SceneLamps(const TraceScene& scene, std::span<const TransferPart> lamps,
               std::span<const glm::vec3> strengths);

    bool has_lights() const { return !lights_.empty(); }
    bool has_surfaces() const { return !shining_.empty(); }

    /// Light of a sample that arrives if nothing is in its way, over what was chosen by chance.
    struct Sample {
        glm::vec3 towards{0, 1, 0}; ///< unit
        glm::vec3 way{0};           ///< to where it comes from, or along which it comes from far away
        float reach = 1;            ///< so many lengths of `way`: endless, or 1
        glm::vec3 irradiance{0};    ///< of what faces it
        float density = 0;          ///< of the direction over the sphere; 0: no other way finds that light

        /// Share of it by the balance heuristic, where directions of that density find it too.
        float balance(float other) const { return density > 0 ? density / (density + other) : 1.0f; }
    };
    /// One of the lights of KHR_lights_punctual, by what they give at `place`, points without extent.
    Sample sample_light(const glm::vec3& place, float u) const;
    /// A point of the surfaces that shine, by their power; black where its back is seen.
    Sample sample_surface(const glm::vec3& place, const glm::vec2& u) const;
    /// Share of the light of a sample of `place` that comes through to there.
    float open(const glm::vec3& place, const Sample& sample) const;

    /// What a point of a triangle gives off to where it is seen from, on its front or its back.
    glm::vec3 radiance(const SurfacePoint& point, bool back) const;
    /// Of `sample_surface`, for a direction at this cosine to the triangle that meets it so far away.
    float density(std::uint32_t triangle, float distance, float cosine) const;

private:
    struct Light {
        std::uint32_t index; ///< in Scene::lights
        glm::vec3 strength;
    };
    struct Shining {
        std::uint32_t triangle;
        double until; ///< the sum of powers up to it
    };

    glm::vec3 strength_of(std::uint32_t triangle) const;
    Sample of_light(const Light& light, const glm::vec3& place) const;

    const TraceScene& scene_;
    std::vector<Light> lights_;
    std::vector<Shining> shining_;
    std::vector<glm::vec3> strengths_; ///< [materials]
    std::vector<double> densities_;    ///< [triangles] of a point over the area; empty: nothing shines
};

} // namespace prt
