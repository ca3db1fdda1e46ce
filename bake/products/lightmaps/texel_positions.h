#pragma once

// Positions of samples of texels in space.

#include "bake/products/lightmaps/texel_samples.h"
#include "bake/scene/receivers.h"
#include "bake/scene/trace_scene.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Surfaces that cast shadows instead of the surfaces of the texels: a finer model of the same object.
struct Casters {
    const TraceScene& scene;
    double reach; ///< maximum distance in metres at which the finer surface is searched, on both sides
};

/// Positions of samples as receivers: on the surface, or on the surface of `casters` if it is within reach
/// above or below and faces the same direction.
class TexelPositions {
public:
    /// Keeps references. `casters` null: the scene itself blocks light.
    TexelPositions(const Scene& scene, const Casters* casters);
    /// Appends a receiver of that area.
    void append(const TexelSample& sample, float area, Receivers& receivers) const;
    /// Returns a notice if many of the samples so far found no surface of `casters`, otherwise no value.
    /// Throws `Error` if no sample found one, because the model then has other surfaces.
    std::optional<std::string> check_casters() const;
    /// Area of a triangle of the scene, m².
    double area(std::uint32_t triangle) const;

private:
    struct Position {
        glm::vec3 position, normal, plane;
    };
    void move_to_casters(Position& position) const;

    std::vector<glm::uvec3> corners_; ///< [triangles]
    Receivers vertices_, of_casters_;
    const Casters* casters_;
    mutable std::atomic<std::size_t> asked_ = 0, found_ = 0; ///< samples, of those that casters have
    glm::vec3 from_scene_{0};                                ///< to the origin of the casters
};

} // namespace prt
