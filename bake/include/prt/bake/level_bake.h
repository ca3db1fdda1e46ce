#pragma once

// Transfer of coarser levels of detail: fitted to the transfer of level 0, which makes the levels look the
// same, or baked independently (docs/math.md, section 23). Experimental.

#include "prt/bake/bake.h"
#include "prt/core/transfer.h"
#include "prt/gltf/levels.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A first point, on a coarser level, and a second point, on level 0, whose light the first point should
/// show.
struct LevelSample {
    /// Corners of a triangle, as receivers of the scene with all levels. `at`: the triangle of the coarser
    /// level that contains the first point; `from`: the triangle of level 0 that contains the second point.
    std::array<std::uint32_t, 3> at, from;
    /// Barycentric coordinates. `shares`: of the first point in triangle `at`; `from_shares`: of the second
    /// point in triangle `from`. All `from_shares` are 0 if level 0 has no suitable point; the coarser level
    /// should then be dark at the first point.
    std::array<float, 3> shares, from_shares;
    float area = 0; ///< area of the coarser level in m² that the sample represents
};

/// Samples over one level of one node.
struct LevelSamples {
    std::vector<LevelSample> samples;
    /// Distance from the samples to their points on level 0 in metres: root mean square weighted by area, and
    /// maximum. Samples without a point on level 0 do not count.
    double rms_distance = 0, largest_distance = 0;
    /// Diagonal of the bounding box of level 0, metres. If level 0 consists of several nodes of the file: the
    /// largest of their diagonals.
    double diagonal = 0;
};

/// Source of the transfer of coarser levels.
enum class LevelMode {
    carry,  ///< they copy the transfer of level 0
    own,    ///< each level is baked in place of level 0
    ignore, ///< levels are ignored
};
/// Returns "carry", "own" or "ignore".
const char* to_string(LevelMode mode);

/// Settings for levels.
struct LevelOptions {
    std::uint64_t seed = 0; ///< seed of the positions of samples
    int threads = 0;        ///< number of threads; 0: all
    /// Receivers of level 0 inside solid geometry, in ascending order (BakeResult::sealed); may be empty.
    std::span<const std::uint32_t> sealed = {};
};

/// Throws `Error` if the root mean square distance of a coarser level from level 0 exceeds a quarter of
/// LevelSamples::diagonal, because a level at this distance cannot show the light of level 0. Uses few
/// samples, and ignores LevelOptions::seed. Call this function before a bake to find the error early:
/// `carry_levels` and `bake_levels` check the distances after the bake. Throws `Cancelled` after a stop
/// request.
void check_levels(const LeveledScene& scene, const LevelOptions& options = {}, const Progress& progress = {});

/// Returns samples spread over `level` of `node`, each with its point on level 0 if there is one. `node` must
/// be one of the nodes of `scene`, and `level` one of its levels. Throws the errors of `check_levels` for
/// this level.
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

/// Returns the squared error of a coarser level against level 0 at `samples`. `finest` and `level` contain
/// values of all receivers of the scene with its levels, [receivers][columns]. The function reads receivers
/// of level 0 from `finest`, and receivers of the coarser level from `level`. It multiplies the squares of
/// column i by column_weights[i].
LevelSquares level_error(const LevelSamples& samples, std::span<const float> finest,
                         std::span<const float> level, std::span<const float> column_weights);
/// Returns the squared error of the transfer of a coarser level against level 0 at `samples`. `finest` and
/// `level` have the same layout and contain all receivers of the scene with its levels. The function reads
/// receivers of level 0 from `finest`, and receivers of the coarser level from `level`. A term with one
/// channel counts for all channels of the layout, as in `relative_l2`.
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
    /// Transfer of all receivers of the scene with its levels. The first LeveledScene::finest_receivers
    /// receivers have the transfer that the caller passed.
    Transfer transfer;
    /// One result per coarser level, node by node, in the order of LeveledNode::coarser.
    std::vector<LevelOutcome> levels;
    /// Receivers of coarser levels that are inside solid geometry. `carry_levels`: the nearest triangle of
    /// level 0 is completely inside, by LevelOptions::sealed.
    std::vector<std::uint32_t> sealed;
    double seconds = 0;               ///< wall-clock time in seconds
    std::vector<std::string> notices; ///< levels that are far from level 0, one line each; always empty
                                      ///< after `bake_levels`
};

/// Computes the transfer of coarser levels without rays: fits their vertices to the transfer of level 0 at
/// samples, by least squares. `finest` is the transfer of the first receivers of the scene,
/// [scene.finest_receivers]. The result does not depend on the number of threads. Throws the errors of
/// `check_levels`.
LevelBake carry_levels(const LeveledScene& scene, const Transfer& finest, const LevelOptions& options = {},
                       const Progress& progress = {});

/// Bakes each coarser level independently of level 0. For each level number there is one bake of a scene in
/// which the levels with this number replace level 0; nodes without this level show level 0. `finest` is the
/// transfer of the first receivers of the scene, [scene.finest_receivers]. Throws the errors of `bake` and
/// `check_levels`, and `Error` if the layout of a baked level differs from the layout of `finest`. `finer`:
/// as for `bake`.
LevelBake bake_levels(const LeveledScene& scene, const Transfer& finest, const BakeOptions& options,
                      const Progress& progress = {}, const FinerModel& finer = {});

/// Returns the result of `bake_levels` or `carry_levels`, as `mode` requests, which must not be `ignore`.
/// `sealed`: receivers of level 0 inside solid geometry, as in LevelOptions.
LevelBake transfer_of_levels(const LeveledScene& scene, const Transfer& finest, LevelMode mode,
                             const BakeOptions& options, std::span<const std::uint32_t> sealed,
                             const Progress& progress = {}, const FinerModel& finer = {});

} // namespace prt
