#pragma once

// Where samples of texels lie in space.

#include "prt/receivers.h"
#include "prt/trace_scene.h"
#include "texels/texel_samples.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Surfaces that cast in the place of those that texels are of: a finer model of the same.
struct Casters {
    const TraceScene& scene;
    double reach; ///< metres, that the finer surface is looked for on either side
};

/// Places of samples as receivers: on the surface, or on that of `casters` where one lies over or under it
/// within reach and looks the same way.
class TexelPlaces {
public:
    /// Keeps references. `casters`: null where the scene casts itself.
    TexelPlaces(const Scene& scene, const Casters* casters);
    /// Appends a receiver of that area.
    void append(const TexelSample& sample, float area, Receivers& receivers) const;
    /// A line where many samples so far have found no surface of casters, nothing otherwise. Throws `Error`
    /// where none has: these are other surfaces.
    std::optional<std::string> check_casters() const;
    /// Area of a triangle of the scene, m².
    double area(std::uint32_t triangle) const;

private:
    struct Place {
        glm::vec3 position, normal, plane;
    };
    void move_to_casters(Place& place) const;

    std::vector<glm::uvec3> corners_; ///< [triangles]
    Receivers vertices_, of_casters_;
    const Casters* casters_;
    mutable std::atomic<std::size_t> asked_ = 0, found_ = 0; ///< samples, of those that casters have
    glm::vec3 from_scene_{0};                                ///< to the origin of the casters
};

} // namespace prt
