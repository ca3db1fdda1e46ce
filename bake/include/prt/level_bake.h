#pragma once

// Transfer of coarser levels of detail: fitted to the transfer of level 0, which makes the levels look the
// same, or baked independently (docs/math.md, section 23). Experimental.

#include "prt/bake.h"
#include "prt/levels.h"
#include "prt/transfer.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A point of a coarser level, and the point of level 0 whose light it should show.
struct LevelSample {
    /// Corners of a triangle, as receivers of the scene with all levels. `at`: triangle of the coarser level
    /// with the point; `from`: triangle of level 0 with the other point.
    std::array<std::uint32_t, 3> at, from;
    /// Barycentric coordinates of the point in triangle `at` (`shares`), and of the other point in triangle
    /// `from` (`from_shares`). All `from_shares` are 0 if level 0 has no suitable point; the sample should
    /// then be dark.
    std::array<float, 3> shares, from_shares;
    float area = 0; ///< area of the coarser level in m² that the sample represents
};

/// Samples over one level of one node.
struct LevelSamples {
    std::vector<LevelSample> samples;
    /// Distance from the samples to their points on level 0 in metres: root mean square weighted by area, and
    /// maximum.
    double rms_distance = 0, largest_distance = 0;
    /// Diagonal in metres of the bounding box of level 0; if several nodes of the file form level 0, of the
    /// largest of them.
    double diagonal = 0;
};

/// Settings for levels.
struct LevelOptions {
    std::uint64_t seed = 0; ///< seed of the positions of samples
    int threads = 0;        ///< number of threads; 0: all
};

/// Throws `Error` if the root mean square distance of a coarser level from level 0 exceeds a quarter of
/// LevelSamples::diagonal: such a level cannot show the light of level 0. Uses few samples; call this
/// function before a bake, because `carry_levels` and `sample_level` make the same check later.
void check_levels(const LeveledScene& scene, const LevelOptions& options = {}, const Progress& progress = {});

/// Returns samples spread over `level` of `node`, each with its point on level 0. Throws the errors of
/// `check_levels` for this level, and `Cancelled` after a stop request.
LevelSamples sample_level(const LeveledScene& scene, const LeveledNode& node, const CoarserLevel& level,
                          const LevelOptions& options = {}, const Progress& progress = {});

/// Squared error of a coarser level against level 0. It can be summed over levels.
struct LevelSquares {
    /// `error`: squared differences of the two levels; `norm`: squared values of level 0. Both are sums over
    /// samples, weighted by their areas.
    double error = 0, norm = 0;

    /// Returns the square root of `error` over `norm`; 0 if `norm` is 0.
    double relative_l2() const;
    LevelSquares& operator+=(const LevelSquares& other);
};

/// Returns the squared error of a coarser level against level 0 at `samples`. Both `finest` and `level` are
/// interleaved values of all receivers of the scene with its levels, [receivers][columns]: the receivers of
/// level 0 are read from `finest`, those of the coarser level from `level`. `column_weights` [columns]:
/// factors on the squares of each column.
LevelSquares level_error(const LevelSamples& samples, std::span<const float> finest,
                         std::span<const float> level, std::span<const float> column_weights);
/// Returns the squared error of the transfer of a coarser level against level 0 at `samples`. `finest` and
/// `level` have the same layout and contain all receivers of the scene with its levels: the receivers of
/// level 0 are read from `finest`, those of the coarser level from `level`. A term with one channel counts
/// for all channels of the layout, as in `relative_l2`.
LevelSquares level_error(const LevelSamples& samples, const Transfer& finest, const Transfer& level);

/// Result for one level of one node.
struct LevelOutcome {
    /// `name`: name of the level; `of`: name of the node that the level replaces.
    std::string name, of;
    int level = 1; ///< number of the level, from 1
    /// Numbers of triangles and vertices of the level, and of samples over it.
    std::size_t triangles = 0, vertices = 0, samples = 0;
    double rms_distance = 0, largest_distance = 0, diagonal = 0; ///< metres, as in `LevelSamples`
    LevelSquares squares;                                        ///< error against level 0 at the samples
};

/// Result of `carry_levels` and `bake_levels`.
struct LevelBake {
    /// Transfer of all receivers of the scene with its levels. The first receivers, those of level 0, have
    /// the transfer that the caller passed.
    Transfer transfer;
    std::vector<LevelOutcome>
        levels;         ///< one result per coarser level, node by node, in the order of LeveledNode::coarser
    double seconds = 0; ///< wall-clock time in seconds
    std::vector<std::string> notices; ///< problems that do not prevent the result, one line each
};

/// Computes the transfer of coarser levels without rays: fits their vertices to the transfer of level 0 at
/// samples, by least squares. `finest` is the transfer of the receivers of level 0, [scene.finest_receivers].
/// The result does not depend on the number of threads. Throws the errors of `check_levels`, and `Cancelled`
/// after a stop request.
LevelBake carry_levels(const LeveledScene& scene, const Transfer& finest, const LevelOptions& options = {},
                       const Progress& progress = {});

/// Bakes each coarser level independently of level 0. For each level number there is one bake of a scene in
/// which the levels with this number replace level 0. `finest` is the transfer of the receivers of level 0,
/// [scene.finest_receivers]. Throws the errors of `bake` and `check_levels`, and `Error` if the layout of a
/// baked level differs from the layout of `finest`.
LevelBake bake_levels(const LeveledScene& scene, const Transfer& finest, const BakeOptions& options,
                      const Progress& progress = {});

} // namespace prt
