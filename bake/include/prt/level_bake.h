#pragma once

// Transfer of coarser levels of detail: fitted to that of level 0, so that the levels look the same, or baked
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

/// A point of a coarser level, and the point of level 0 whose light it should show. Indices are receivers of
/// the scene with all levels.
struct LevelSample {
    std::array<std::uint32_t, 3> at, from;    ///< corners of the triangle of the coarser level (`at`), and of
                                              ///< the triangle of level 0 (`from`)
    std::array<float, 3> shares, from_shares; ///< barycentric coordinates of the points in these triangles
    float area = 0;                           ///< area in m² that the sample represents
};

/// Samples over one level of one node.
struct LevelSamples {
    std::vector<LevelSample> samples;
    /// Distance from the samples to their points on level 0, metres.
    double rms_distance = 0, largest_distance = 0;
    double diagonal = 0; ///< diagonal of the bounding box of the largest node of level 0, metres
};

/// Settings for levels.
struct LevelOptions {
    std::uint64_t seed = 0;
    int threads = 0; ///< number of threads; 0: all
};

/// Throws `Error` if a level is too far from level 0 to take its transfer. Uses few samples; call it before a
/// bake.
void check_levels(const LeveledScene& scene, const LevelOptions& options = {}, const Progress& progress = {});

/// Returns samples spread over `level` of `node`, each with its point on level 0. Throws the errors of
/// `check_levels`.
LevelSamples sample_level(const LeveledScene& scene, const LeveledNode& node, const CoarserLevel& level,
                          const LevelOptions& options = {}, const Progress& progress = {});

/// Squared error of a level against level 0, and squared values of level 0; both are sums over samples,
/// weighted by area.
struct LevelSquares {
    double error = 0, norm = 0;

    double relative_l2() const;
    LevelSquares& operator+=(const LevelSquares& other);
};

/// Returns the squared error of values of a level (`level`) against level 0 (`finest`) at the samples. Both
/// are values of all receivers of the scene with its levels, [receivers][columns]. Squares of column i are
/// multiplied by column_weights[i].
LevelSquares level_error(const LevelSamples& samples, std::span<const float> finest,
                         std::span<const float> level, std::span<const float> column_weights);
/// Returns the squared error of transfer of a level against level 0, in the same layout. A term with one
/// channel counts for all channels of the layout, as in `relative_l2`.
LevelSquares level_error(const LevelSamples& samples, const Transfer& finest, const Transfer& level);

/// Result for one level of one node.
struct LevelOutcome {
    std::string name, of; ///< name of the level, and name of the node that it replaces
    int level = 1;
    std::size_t triangles = 0, vertices = 0, samples = 0;
    double rms_distance = 0, largest_distance = 0, diagonal = 0; ///< metres
    LevelSquares squares;                                        ///< error against level 0, at the samples
};

/// Result of `carry_levels` and `bake_levels`.
struct LevelBake {
    Transfer transfer; ///< transfer of all receivers of the scene with its levels; vectors of level 0 are
                       ///< those of `finest`
    std::vector<LevelOutcome> levels; ///< results, node by node
    double seconds = 0;
    std::vector<std::string> notices; ///< one line each
};

/// Computes the transfer of coarser levels by a least-squares fit of their vertices to the transfer of level
/// 0 at samples. `finest` is the transfer of the receivers of level 0, [scene.finest_receivers]. The result
/// does not depend on the number of threads. Throws the errors of `check_levels`.
LevelBake carry_levels(const LeveledScene& scene, const Transfer& finest, const LevelOptions& options = {},
                       const Progress& progress = {});

/// Bakes each level independently. For each level number there is one bake, of a scene in which the levels of
/// this number replace level 0. Throws the errors of `bake`, and `Error` if the layout of the result differs
/// from that of `finest`.
LevelBake bake_levels(const LeveledScene& scene, const Transfer& finest, const BakeOptions& options,
                      const Progress& progress = {});

} // namespace prt
