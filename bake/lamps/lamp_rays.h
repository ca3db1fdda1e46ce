#pragma once

// Shadow rays from a receiver to one lamp.

#include "lamps/choose_lamps.h"
#include "lamps/lamp_geometry.h"
#include "prt/trace_scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// A receiver that light falls on.
struct LampReceiver {
    glm::vec3 position, normal;
    glm::vec3 origin;       ///< where its rays start
    std::uint32_t seed = 0; ///< makes its samples differ from those of others
};

struct LampIrradiance {
    glm::dvec3 irradiance{0};
    std::size_t rays = 0;
};

/// Irradiance by the lights of KHR_lights_punctual of `lamp`: a ray to each, or where they have extent as
/// many over their discs as they have of all light here, `most` in all or one each. Unshadowed it is that of
/// the extension, whatever their radius, but where the light is as near as that.
LampIrradiance irradiance_of_lights(const TraceScene& scene, const Lamp& lamp, const LampReceiver& receiver,
                                    double radius, int most);

/// Takes light that comes in from unit `towards`, as irradiance of what faces it.
using TakeLight = std::function<void(const glm::dvec3& towards, const glm::dvec3& irradiance)>;

/// The same lights one by one, each from its middle: of a place, whatever the receiver's normal is. Returns
/// how many rays it took.
std::size_t take_lights(const TraceScene& scene, const Lamp& lamp, const LampReceiver& receiver,
                        double radius, int most, const TakeLight& take);

/// The triangles of a lamp that shine, with how bright each is on average.
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

    /// Irradiance by `rays` rays that are spread over what is seen of them by its solid angle.
    LampIrradiance irradiance(const LampReceiver& receiver, int rays) const;

    /// The same sample by sample.
    std::size_t take_light(const LampReceiver& receiver, int rays, const TakeLight& take) const;

private:
    /// Of a sample of a triangle that is seen so, as if the triangle were all there is, on what faces it.
    struct Sample {
        glm::dvec3 towards{0}, irradiance{0};
    };
    Sample sample(const LampReceiver& receiver, const Shining& t, const lamp_geometry::SeenTriangle& seen,
                  const glm::dvec2& u) const;

    const TraceScene& scene_;
    std::vector<Shining> triangles_;
};

} // namespace prt
