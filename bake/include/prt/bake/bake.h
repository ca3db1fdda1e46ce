#pragma once

// The baker: computes transfer vectors of every receiver of a scene.

#include "prt/bake/bake_options.h"
#include "prt/core/baked_transfer.h"
#include "prt/core/error.h"
#include "prt/core/progress.h"
#include "prt/load/scene.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Errors of the transfer that a bake returns, measured at random points over the surface against light that
/// is traced at these points. They include the noise of the rays, and the interpolation error of direct light
/// and of all bounces. Points inside geometry, on media and on fully transparent surfaces are excluded.
struct BakeErrors {
    /// An error with its statistical uncertainty.
    struct Error {
        /// Square root of the squared error over the squared light, both weighted by area and summed over
        /// the points; `relative_l2` has the uncertainty `standard_error` (one standard deviation).
        double relative_l2 = 0, standard_error = 0;
        /// Root mean square error at these points, divided by the root mean square light at the points of
        /// the whole scene; 0 if the scene has no light or there are fewer than two points.
        double of_scene = 0;
        bool known = false; ///< false if there are fewer than two points, or no light at them; `relative_l2`
                            ///< and `standard_error` are then 0
    };
    /// Error of one lamp term.
    struct LampError {
        std::string name; ///< name of the lamp or of its group
        Error error;      ///< error relative to the baked light of this lamp, see `LampMode`
    };
    /// Errors at the points of one node of the file. `Error::relative_l2` is relative to the light at the
    /// points of this node, `Error::of_scene` to the light at the points of the whole scene.
    struct Node {
        std::string name; ///< name of the node
        /// `sky`: error of all light of the sky; `lamps`: error of the terms of all lamps together; `backs`,
        /// `backs_by_lamps`: errors of the light of the sky and of lamps on back sides, as in `BakeErrors`.
        Error sky, lamps, backs, backs_by_lamps;
        std::size_t points = 0; ///< number of points on the node
    };
    std::size_t points = 0; ///< number of points on all surfaces
    Error sky;              ///< error of all light of the sky
    /// `direct`: error of the sky's light without bounces; `indirect`: error of the sky's light after bounces
    /// or through media. Both are relative to all light of the sky.
    Error direct, indirect;
    Error lamps; ///< error of the terms of all lamps together, each lamp with strength 1
    /// Errors on back sides that have no receivers and therefore show the light of the front side. `backs`:
    /// error of the light of the sky, at points where direct light of the sky reaches the back.
    /// `backs_by_lamps`: error of the light of lamps, at points where direct light of lamps reaches the back.
    /// A node whose back sides get almost no light has no points here, unless its surface transmits light.
    Error backs, backs_by_lamps;
    std::vector<LampError> each_lamp = {}; ///< [lamp terms] in the order of the terms
    std::vector<Node> nodes = {};          ///< nodes with at least one point, in the order of their first
                                           ///< primitives
};

/// Noise of rays that remains in the light of receivers after the noise filter: estimated relative L2 error.
/// A value of 0 means that the noise is unknown.
struct BakeNoise {
    bool filtered = false; ///< true: the noise filter was applied
    double sky = 0;        ///< noise of all light of a sky
    double direct = 0;     ///< noise of a sky's light without bounces, relative to all light of the sky
    double indirect = 0;   ///< noise of a sky's light after bounces, relative to all light of the sky
    /// [lamp terms] noise of each lamp's light after bounces, relative to all baked light of the lamp; empty
    /// if the noise of lamps was not estimated.
    std::vector<double> lamps{};
};

/// Measurements of a bake.
struct BakeStatistics {
    /// Result of the test for FitMode::automatic and FitMode::surface, which compares light at points between
    /// vertices with the interpolation of light at vertices. All values are 0 if no test points were traced.
    struct Fit {
        int samples = 0;     ///< number of surface samples that share the rays of one receiver; 0: light is
                             ///< measured at vertices
        double between = 0;  ///< relative L2 error of the interpolation of direct light between vertices,
                             ///< without noise
        double sampling = 0; ///< relative L2 error of direct light by noise of one receiver's rays
    };
    /// Numbers of receivers.
    struct Receivers {
        std::size_t all = 0; ///< receivers of the scene, which are its vertices
        /// Receivers of the scene with an area. Rays are traced from them, or with a surface fit from samples
        /// of their surface. The other receivers take the transfer of a receiver at the same position, or are
        /// dark.
        std::size_t traced = 0;
        std::size_t back_sides = 0; ///< additional receivers on back sides of surfaces that scatter light on
                                    ///< both sides; the result does not contain them
        std::size_t sealed = 0;     ///< receivers of the scene inside solid geometry, where no light arrives
        std::size_t refilled = 0;   ///< sealed receivers that took the values of their
                                    ///< neighbours
    };
    /// Wall-clock time of the stages of the bake in seconds.
    struct Seconds {
        double build = 0;     ///< time for building acceleration structures; loading textures is not included
        TraceSeconds tracing; ///< time for tracing rays
        double transport = 0; ///< time for bounces, subsurface scattering, and the noise filter or the
                              ///< solution of the surface fit
        double all = 0;       ///< total time; loading textures is not included
    };
    /// Size of the sparse operator that applies a bounce; all values are 0 if no light bounces.
    struct Gather {
        /// `entries`: number of stored elements of the operator; `bytes`: their size in memory.
        std::size_t entries = 0, bytes = 0;
        std::size_t bytes_moved = 0; ///< bytes transferred to and from the device that applied the operator;
                                     ///< 0: the CPU applied it
    };
    /// Numbers of light sources of the scene that were baked.
    struct Lamps {
        /// `count`: number of lamp terms; `lights`: number of punctual lights in these terms; `triangles`:
        /// number of emissive triangles in these terms.
        std::size_t count = 0, lights = 0, triangles = 0;
    };
    Receivers receivers;
    Fit fit;
    std::size_t rays = 0; ///< number of all traced rays, including those of lamps, tests and error estimates
    std::string device;   ///< name of the device that traced the rays, for reports
    Seconds seconds;
    /// Share of a uniform sky's light that arrives without bounces, 0..1: mean over the receivers, weighted
    /// by area, of T_0 / Y_00. T_0 is the first coefficient of direct light, Y_00 the constant SH function.
    double mean_visibility = 0;
    /// Estimated relative L2 error of the transfer by noise of rays. It applies to all light of the sky after
    /// the noise filter if BakeNoise::filtered, otherwise to direct light of the sky. 0 for
    /// BakeMethod::raster without a target error, whose error is not estimated.
    double sampling_error = 0;
    double rounding_error = 0; ///< relative L2 error that storing the transfer as float16 causes; computed
                               ///< even if the result is stored as float32
    /// Largest norm of a transfer vector of the bounces that were not computed, estimated as a geometric
    /// series, divided by the largest norm of a baked transfer vector. 0 if no bounce was
    /// computed, 1 if the last bounce is not darker than the bounce before it. For kEndlessBounces without
    /// media: the estimated error of the sum over all bounces, relative to the largest coefficient. With
    /// lamps: the larger of the values for the sky and for the lamps. 0 with a high-poly model.
    double remaining_energy = 0;
    Lamps lamps;
    Gather gather;
    std::vector<std::string> notices; ///< parts of the scene that the bake left out or repaired, with
                                      ///< reasons, one line each

    /// Returns all traced rays divided by the total time, per second.
    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

/// Result of a bake.
struct BakeResult {
    BakedTransfer baked; ///< transfer of all vertices of the scene
    /// Indices of receivers inside solid geometry, which no light reaches and which are never visible; in
    /// ascending order.
    std::vector<std::uint32_t> sealed;
    BakeStatistics statistics;
    BakeNoise noise;                  ///< noise that remains after the noise filter
    std::optional<BakeErrors> errors; ///< errors over the surface; no value unless MeasureErrors::yes
};

/// Selects whether a bake measures `BakeErrors`, with the additional rays of several hundred to several
/// thousand receivers.
enum class MeasureErrors { no, yes };

/// Error of a bake with kEndlessBounces and lamps: the sum over the bounces of a lamp's light does not
/// converge. The usual reason is a closed room that reflects all light.
struct EndlessLampLight : Error {
    using Error::Error;
};

/// Bakes transfer for every vertex of `scene`. On the CPU the result is deterministic for a given seed and
/// does not depend on the number of threads. Throws `Error` for invalid options, media or lamp groups, for a
/// missing or damaged texture (BadTextures::error), for a lamp that is too bright for files, for a bake that
/// does not fit into memory, and if the backend is not available. Throws `Error` if the GPU of Backend::gpu
/// fails, `EndlessLampLight` if the light of lamps does not converge, and `Cancelled` after a stop request.
/// If `finer` has a scene, light bounces between the vertices of that model, and the vertices of `scene`
/// gather it; the media and thin sheets of `scene` scatter the light at its vertices. Throws `Error` if
/// `finer` is invalid or has no surface near the vertices.
BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress = {},
                MeasureErrors errors = MeasureErrors::no, const FinerModel& finer = {});

} // namespace prt
