#pragma once

// The surface of a coarser level, its samples, and the level 0 that it replaces.

#include "bake/products/levels/nearest_points.h"
#include "bake/scene/scene_part.h"
#include "bake/surface_fit/surface_samples.h"
#include "prt/bake/level_bake.h"

namespace prt {

/// Returns the scene in which all nodes that have level `number` show it; 0: level 0.
ScenePart with_level(const LeveledScene& scene, std::size_t number);

/// Some primitives as a surface. It cannot be moved, because other objects keep references to it.
struct PartSurface {
    PartSurface(const Scene& scene, std::span<const std::size_t> primitives, int threads);
    PartSurface(const PartSurface&) = delete;
    PartSurface& operator=(const PartSurface&) = delete;

    ScenePart part; ///< all its materials cast shadows
    TraceScene traced;
    TransportReceivers receivers;

    const Receivers& points() const { return receivers.receivers; }
};

/// Finds the point of level 0 whose light a point of a coarser level shows.
class FinestSurface {
public:
    FinestSurface(const LeveledScene& scene, const LeveledNode& node, int threads)
        : surface_(scene.scene, node.finest, threads), positions_(surface_.traced, surface_.points()),
          threads_(threads) {}

    /// Returns the nearest point for each position, [positions], in parallel.
    std::vector<NearestPoint> find(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                   const Progress& progress) const;
    /// Corners of a triangle as receivers of the scene with all levels.
    std::array<std::uint32_t, 3> corners(std::uint32_t triangle) const;
    double diagonal() const { return positions_.diagonal(); }

private:
    PartSurface surface_;
    NearestPoints positions_;
    int threads_;
};

/// Finds the point of level 0 for each of `samples` on `level`.
LevelSamples match_samples(const SurfaceSamples& samples, const PartSurface& level,
                           const FinestSurface& finest, const Progress& progress);
/// Throws `Error` if the level is too far from its node.
void check_distance(const LevelSamples& samples, const LeveledNode& node, const CoarserLevel& level);

/// Spreads samples over `level`; their number depends on its receivers and on those of level 0.
SurfaceSamples samples_of(const PartSurface& level, std::size_t finest_receivers, std::uint64_t seed);

/// Creates the result of a level without its error.
LevelOutcome outcome_of(const Scene& scene, const LeveledNode& node, const CoarserLevel& level,
                        const LevelSamples& samples);

} // namespace prt
