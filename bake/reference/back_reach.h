#pragma once

// Determines which backs of surfaces receive light.

#include "bake/reference/light_paths.h"
#include "bake/reference/scene_lamps.h"
#include "bake/trace/choose_lamps.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Minimum mean reach of a part of a surface, above the light through cracks of solids.
inline constexpr double kMinReach = 1e-3;

/// Paths that search for light. The reach of a path starts at 1 and is halved at each surface that the path
/// hits, until it ends in the sky above the horizon, or until a random point of a lamp is visible. A thin
/// sheet continues it on either side by chance. The reach is 0 if the path finds no light in eight bounces.
/// The reach is an order of magnitude only.
class BackReach {
public:
    /// `lamps`: lamps that are lit. Keeps a reference to `scene`.
    BackReach(const TraceScene& scene, std::span<const Lamp> lamps, std::uint64_t seed);

    struct Path {
        float reach = 0;
        bool at_home = true; ///< hit only backs of its piece
    };
    /// Follows a path from a point on the back of a triangle. `pieces` [triangles] are numbers of connected
    /// surfaces; empty if `at_home` is not needed.
    Path path(std::uint32_t triangle, std::uint32_t seed, std::uint32_t index,
              std::span<const std::uint32_t> pieces = {}) const;
    /// Mean reach of two paths from the back of each of `triangles`.
    std::vector<float> means(std::span<const std::uint32_t> triangles) const;

private:
    bool sees_lamp(const LitSide& side, PathSamples& samples) const;
    std::optional<SurfacePoint> nearest(Ray ray, PathSamples& samples) const;

    const TraceScene& scene_;
    SceneLamps lamps_;
    std::uint64_t seed_;
};

} // namespace prt
