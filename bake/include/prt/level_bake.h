#pragma once

// Transfer of coarser levels of detail: carried over from level 0, so that they look like it, or baked
// independently (docs/math.md, section 23). Experimental.

#include "prt/bake.h"
#include "prt/levels.h"
#include "prt/transfer.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A point of a coarser level, and the point of level 0 whose light it shows. Indices are receivers of the
/// scene with all levels.
struct LevelSample {
    std::array<std::uint32_t, 3> at, from; ///< corners of the triangle of the coarser level, and of the
                                           ///< triangle of level 0
    std::array<float, 3> shares, from_shares;
    float area = 0; ///< m² that the sample represents
};

/// Samples over one level of one node.
struct LevelSamples {
    std::vector<LevelSample> samples;
    double rms_distance = 0, largest_distance = 0; ///< metres, from the samples to their points on level 0
    double diagonal = 0;                           ///< metres, of the bounding box of the largest node of
                                                   ///< level 0
};

struct LevelOptions {
    std::uint64_t seed = 0;
    int threads = 0; ///< number of threads; 0: all
};

/// Throws `Error` if a level is so far from level 0 that there is nothing to carry over. Uses few samples;
/// call it before a bake.
void check_levels(const LeveledScene& scene, const LevelOptions& options = {}, const Progress& progress = {});

/// Spreads samples over one level and finds the point of level 0 for each. Throws the same errors as
/// `check_levels`.
LevelSamples sample_level(const LeveledScene& scene, const LeveledNode& node, const CoarserLevel& level,
                          const LevelOptions& options = {}, const Progress& progress = {});

/// Squared error and squared norm of the values shown at samples, summed by area.
struct LevelSquares {
    double error = 0, norm = 0;

    double relative_l2() const;
    LevelSquares& operator+=(const LevelSquares& other);
};

/// Compares values of level 0 and of the level, both [receivers of the scene][stride]. Each squared column is
/// multiplied by its weight [stride].
LevelSquares level_error(const LevelSamples& samples, std::span<const float> finest,
                         std::span<const float> level, std::span<const float> column_weights);
/// Compares transfer of one layout. A part with one channel counts for all channels of the layout, as in
/// `relative_l2`.
LevelSquares level_error(const LevelSamples& samples, const Transfer& finest, const Transfer& level);

/// Result of one level of one node.
struct LevelOutcome {
    std::string name, of; ///< name of the level, and name of the node that it belongs to
    int level = 1;
    std::size_t triangles = 0, vertices = 0, samples = 0;
    double rms_distance = 0, largest_distance = 0, diagonal = 0; ///< metres
    LevelSquares squares;                                        ///< error against level 0, at the samples
};

struct LevelBake {
    Transfer transfer;                ///< transfer of all receivers of the scene; the vectors of level 0 are
                                      ///< unchanged
    std::vector<LevelOutcome> levels; ///< results, node by node
    double seconds = 0;
    std::vector<std::string> notices; ///< one line each
};

/// Fits the transfer of level 0 to the vertices of coarser levels, by least squares over samples. `finest` is
/// the transfer of the receivers of level 0, [scene.finest_receivers]. Deterministic for any number of
/// threads. Throws the same errors as `check_levels`.
LevelBake carry_levels(const LeveledScene& scene, const Transfer& finest, const LevelOptions& options = {},
                       const Progress& progress = {});

/// Bakes each level independently: once for each level number, in a scene where this level replaces level 0.
/// Throws the same errors as `bake`, and an `Error` if the layout of the result differs from that of
/// `finest`.
LevelBake bake_levels(const LeveledScene& scene, const Transfer& finest, const BakeOptions& options,
                      const Progress& progress = {});

} // namespace prt
