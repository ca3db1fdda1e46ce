#pragma once

// Shadow rays from a receiver to one lamp.

#include "bake/scene/trace_scene.h"
#include "bake/trace/choose_lamps.h"
#include "shared_lamps.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// A receiver of light.
struct LampReceiver {
    glm::vec3 position, normal;
    glm::vec3 origin;       ///< origin of its rays
    std::uint32_t seed = 0; ///< makes its samples differ from those of other receivers
};

struct LampIrradiance {
    glm::dvec3 irradiance{0};
    std::size_t rays = 0;
};

/// Computes the irradiance from the punctual lights of `lamp`: one ray to each light, or for lights with an
/// extent a number of rays over their discs in proportion to their share of the light here, with at most
/// `most` rays in total or one ray per light. The unshadowed value is that of KHR_lights_punctual for any
/// radius, unless the receiver is within the radius of the light.
LampIrradiance irradiance_of_lights(const TraceScene& scene, const Lamp& lamp, const LampReceiver& receiver,
                                    double radius, int most);

/// Takes light from unit direction `towards`, as irradiance of a receiver that faces it.
using TakeLight = std::function<void(const glm::dvec3& towards, const glm::dvec3& irradiance)>;

/// Passes the lights of `lamp` to `take` one by one, each from the direction of its center, for a position
/// without a normal. Returns the number of traced rays.
std::size_t take_lights(const TraceScene& scene, const Lamp& lamp, const LampReceiver& receiver,
                        double radius, int most, const TakeLight& take);

/// The emissive triangles of a lamp with their mean brightness.
class ShiningTriangles {
public:
    struct Shining {
        std::uint32_t triangle;
        glm::dvec3 a, b, c;
        double luminance; ///< mean
        bool two_sided;
    };

    ShiningTriangles(const TraceScene& scene, const Lamp& lamp);

    std::span<const Shining> all() const { return triangles_; }

    /// Computes irradiance with `rays` rays that are distributed over the visible solid angle of the
    /// triangles.
    LampIrradiance irradiance(const LampReceiver& receiver, int rays) const;

    /// Passes the samples of `irradiance` to `take` one by one. Returns the number of traced rays.
    std::size_t take_light(const LampReceiver& receiver, int rays, const TakeLight& take) const;

private:
    /// A sample of a visible triangle as if there were no others: irradiance of a receiver that faces it.
    struct Sample {
        glm::dvec3 towards{0}, irradiance{0};
    };
    Sample sample(const LampReceiver& receiver, const Shining& t, const lamp_geometry::SeenTriangle& seen,
                  const glm::dvec2& u) const;

    const TraceScene& scene_;
    std::vector<Shining> triangles_;
};

} // namespace prt
