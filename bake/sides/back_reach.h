#pragma once

// Which backs of surfaces any light reaches.

#include "lamps/choose_lamps.h"
#include "pictures/light_paths.h"
#include "prt/scene_lamps.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Mean reach of a part of a surface, above what comes through the cracks of solids.
inline constexpr double kMinReach = 1e-3;

/// Paths that look for light. A path has reach 1/2 for each surface that it meets before it ends in the sky
/// above the horizon or where a point of a lamp that is drawn by chance is in sight, 0 where it does not get
/// there in eight bounces: an order of magnitude.
class BackReach {
public:
    /// `lamps` are those that are lit. Keeps references to `scene`.
    BackReach(const TraceScene& scene, std::span<const Lamp> lamps, std::uint64_t seed);

    struct Path {
        float reach = 0;
        bool at_home = true; ///< met nothing but the backs of its piece
    };
    /// From a place on the back of a triangle. `pieces` [triangles] numbers surfaces that hang together, or
    /// is empty where nobody asks.
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
