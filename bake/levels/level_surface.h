#pragma once

// The surface of a coarser level, its samples, and the level 0 that it stands for.

#include "levels/nearest_places.h"
#include "levels/scene_part.h"
#include "prt/level_bake.h"
#include "surface/surface_samples.h"

namespace prt {

/// Some primitives as a surface. Stays where it is.
struct PartSurface {
    PartSurface(const Scene& scene, std::span<const std::size_t> primitives, int threads);
    PartSurface(const PartSurface&) = delete;
    PartSurface& operator=(const PartSurface&) = delete;

    ScenePart part; ///< whose materials all cast shadows
    TraceScene traced;
    TransportReceivers receivers;

    const Receivers& points() const { return receivers.receivers; }
};

/// Where level 0 shows what a place of a coarser level shows.
class FinestSurface {
public:
    FinestSurface(const LeveledScene& scene, const LeveledNode& node, int threads)
        : surface_(scene.scene, node.finest, threads), places_(surface_.traced, surface_.points()),
          threads_(threads) {}

    /// [points], in parallel.
    std::vector<NearestPlace> find(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                   const Progress& progress) const;
    /// Receivers of the scene with all levels.
    std::array<std::uint32_t, 3> corners(std::uint32_t triangle) const;
    double diagonal() const { return places_.diagonal(); }

private:
    PartSurface surface_;
    NearestPlaces places_;
    int threads_;
};

/// `samples` of `level`, each with its place.
LevelSamples match_samples(const SurfaceSamples& samples, const PartSurface& level,
                           const FinestSurface& finest, const Progress& progress);
/// Throws `Error` as `sample_level`.
void check_distance(const LevelSamples& samples, const LeveledNode& node, const CoarserLevel& level);

/// How many samples a level gets.
SurfaceSamples samples_of(const PartSurface& level, std::size_t finest_receivers, std::uint64_t seed);

/// All but its error.
LevelOutcome outcome_of(const Scene& scene, const LeveledNode& node, const CoarserLevel& level,
                        const LevelSamples& samples);

} // namespace prt
