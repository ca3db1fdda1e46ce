#pragma once

// Transfer of coarser levels of detail: carried over from level 0, so that they look like it, or baked on
// their own (docs/math.md, section 23). Experimental.

#include "prt/bake.h"
#include "prt/levels.h"
#include "prt/transfer.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// A point of a coarser level, and the place of level 0 whose light it shows. Indices are receivers of the
/// scene with all levels.
struct LevelSample {
    std::array<std::uint32_t, 3> at, from; ///< corners of the triangle here, and of that of level 0
    std::array<float, 3> shares, from_shares;
    float area = 0; ///< m² that it stands for
};

/// Samples all over one level of one node.
struct LevelSamples {
    std::vector<LevelSample> samples;
    double rms_distance = 0, largest_distance = 0; ///< metres, from the samples to their places
    double diagonal = 0;                           ///< metres, of the box of the largest node of level 0
};

struct LevelOptions {
    std::uint64_t seed = 0;
    int threads = 0; ///< 0: all
};

/// Throws `Error` where a level stands so far from level 0 that there is nothing to carry over: by few
/// samples, before a bake.
void check_levels(const LeveledScene& scene, const LevelOptions& options = {}, const Progress& progress = {});

/// Throws `Error` as `check_levels`.
LevelSamples sample_level(const LeveledScene& scene, const LeveledNode& node, const CoarserLevel& level,
                          const LevelOptions& options = {}, const Progress& progress = {});

/// Squares of what is shown at samples, by their areas.
struct LevelSquares {
    double error = 0, norm = 0;

    double relative_l2() const;
    LevelSquares& operator+=(const LevelSquares& other);
};

/// Of values of level 0 and of the level, both [receivers of the scene][stride], each squared column
/// multiplied by its weight [stride].
LevelSquares level_error(const LevelSamples& samples, std::span<const float> finest,
                         std::span<const float> level, std::span<const float> column_weights);
/// Of transfer of one layout: three channels, as `relative_l2`.
LevelSquares level_error(const LevelSamples& samples, const Transfer& finest, const Transfer& level);

/// What came of one level of one node.
struct LevelOutcome {
    std::string name, of; ///< of the level, and of the node that it is of
    int level = 1;
    std::size_t triangles = 0, vertices = 0, samples = 0;
    double rms_distance = 0, largest_distance = 0, diagonal = 0; ///< metres
    LevelSquares squares;                                        ///< against level 0, at the samples
};

struct LevelBake {
    Transfer transfer;                ///< of all receivers of the scene; those of level 0 are as they were
    std::vector<LevelOutcome> levels; ///< node by node
    double seconds = 0;
    std::vector<std::string> notices; ///< a line each
};

/// The transfer of level 0 on the surface of coarser levels, by least squares over samples. `finest`: of the
/// receivers of level 0, [scene.finest_receivers]. Deterministic, whatever the threads. Throws `Error` as
/// `check_levels`.
LevelBake carry_levels(const LeveledScene& scene, const Transfer& finest, const LevelOptions& options = {},
                       const Progress& progress = {});

/// Bakes each level on its own: the scene with it in the place of level 0, once for each number of a level.
/// Throws `Error` as `bake`, and where it has other parts than `finest`.
LevelBake bake_levels(const LeveledScene& scene, const Transfer& finest, const BakeOptions& options,
                      const Progress& progress = {});

} // namespace prt
