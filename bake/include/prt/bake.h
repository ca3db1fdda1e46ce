#pragma once

// The baker: computes transfer vectors of every receiver of a scene.

#include "prt/baked_transfer.h"
#include "prt/make_tracer.h"
#include "prt/scene.h"
#include "prt/subsurface.h"
#include "prt/support/progress.h"
#include "prt/texture.h"

#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Treatment of receivers that no light can reach because they are inside solid geometry.
enum class Inside {
    refill, ///< they take the values of their neighbours, which avoids dark seams where solids meet
    keep,   ///< keep them dark
};

/// Points of a surface where light is measured.
enum class FitMode {
    automatic, ///< `surface` if test points between the vertices show that it has a lower error, otherwise
               ///< `vertex`
    vertex,    ///< at the vertices
    surface,   ///< over the surface: vertex values are a least-squares fit of their interpolation to samples
               ///< between the vertices (Kavan, Bargteil and Sloan 2011)
};

/// Value for the number of bounces: all bounces, until the remaining light is negligible.
inline constexpr int kEndlessBounces = -1;
/// Maximum of a finite number of bounces. Endless bounces through media also stop at this number.
inline constexpr int kMaxBounces = 10000;
inline constexpr int kMaxRays = 1 << 24; ///< maximum number of rays per receiver

/// Assigns a medium to the materials with the name `material`, or to all materials if it is empty.
struct MediumChoice {
    std::string material;
    Medium medium;
};

/// Settings of subsurface scattering.
struct SubsurfaceOptions {
    std::vector<MediumChoice> media; ///< media that replace those of the materials
    double metres_per_unit = 1;      ///< size of the scene's unit in metres
};

/// Selects the light of lamps that is baked. Lamps are lights of KHR_lights_punctual and emissive materials.
enum class LampMode {
    all,
    indirect, ///< light after at least one bounce, for renderers that add the direct light of lamps
              ///< themselves
    none,
};

/// Group of lamps that are dimmed together: all lamps whose names match `pattern` (* matches any letters, ?
/// matches one).
struct LampGroup {
    std::string name, pattern;
};

/// Settings for lamps.
struct LampOptions {
    LampMode mode = LampMode::all;
    std::vector<LampGroup> groups; ///< a lamp belongs to the first group that it matches
    double radius = 0;             ///< radius of point and spot lights in metres; a larger radius makes their
                                   ///< shadows softer
    int rays = 64; ///< number of rays from a receiver to all lamps of one name that have an extent
};

/// Treatment of faults in a scene, and of noise.
struct Repairs {
    BadTextures bad_textures = BadTextures::error;
    Inside inside = Inside::refill;
    /// True: filter the light of receivers over the surface, as strongly as its noise requires.
    bool denoise = true;
};

/// Memory limit, and number format of the result.
struct BakeMemory {
    double limit = 0; ///< bytes; 0: memory of the machine or its container
    /// If empty: float16 if its rounding error is below a tenth of the sampling error, otherwise float32.
    std::optional<TransferStorage> storage = {};
};

/// Relative L2 errors of the transfer that a bake wrote, measured at points over the surface. They include
/// noise and interpolation of all bounces.
struct BakeErrors {
    /// An error with its statistical uncertainty.
    struct Error {
        double relative_l2 = 0, standard_error = 0;
        /// Root mean square error, divided by the root mean square light of the whole scene.
        double of_scene = 0;
        bool known = false; ///< false if there are too few points or no light; `relative_l2` is then 0
    };
    struct LampError {
        std::string name;
        Error error;
    };
    struct Node {
        std::string name;
        Error sky, lamps, backs, backs_by_lamps;
        std::size_t points = 0;
    };
    std::size_t points = 0;
    Error sky;              ///< error of all light of the sky
    Error direct, indirect; ///< errors of light without bounces, and of light after bounces; both relative to
                            ///< all light of a sky
    Error lamps;            ///< error of the light of all lamps at the strengths of the scene
    /// Errors of back sides of two-sided surfaces that show the light of their front sides, although direct
    /// light of the sky (`backs`) or of lamps (`backs_by_lamps`) reaches the back.
    Error backs, backs_by_lamps;
    std::vector<LampError> each_lamp = {};
    std::vector<Node> nodes = {}; ///< in the order of their first primitives
};

/// Settings of a bake.
struct BakeOptions {
    int order = 6;
    int rays = 1024;                    ///< rays per receiver; for method raster the number of directions
    std::optional<double> target_error; ///< target relative L2 error; the number of rays is then chosen per
                                        ///< receiver
    FitMode fit = FitMode::vertex;
    int bounces = 0; ///< number of bounces, or kEndlessBounces
    TracerChoice tracer;
    SubsurfaceOptions subsurface;
    LampOptions lamps;
    Repairs repairs;
    BakeMemory memory;
    int threads = 0; ///< number of threads; 0: all
    std::uint64_t seed = 0;
};

/// Noise of rays that remains in the filtered light, relative L2, estimated from two halves of the rays. A
/// value is 0 if it is unknown.
struct BakeNoise {
    bool filtered = false;
    double sky = 0;      ///< noise of all light of a sky
    double direct = 0;   ///< noise of light without bounces, relative to all light of a sky
    double indirect = 0; ///< noise of light after bounces, relative to all light of a sky
    /// Noise of the light of each lamp after bounces, relative to all baked light of the lamp.
    std::vector<double> lamps{};
};

/// Measurements of a bake.
struct BakeStatistics {
    /// Result of the vertex-fit test; all zero if no test points were traced.
    struct Fit {
        int samples = 0;     ///< number of surface samples that share the rays of one receiver; 0: light is
                             ///< measured at vertices
        double between = 0;  ///< interpolation error of direct light between vertices (relative L2), noise
                             ///< removed
        double sampling = 0; ///< noise of one receiver's rays (relative L2)
    };
    struct Receivers {
        std::size_t all = 0;        ///< receivers of the scene
        std::size_t traced = 0;     ///< receivers on a surface; the others have zero transfer
        std::size_t back_sides = 0; ///< additional receivers on back sides of surfaces that scatter on both
                                    ///< sides
        std::size_t sealed = 0;     ///< receivers inside geometry, where no light arrives
        std::size_t refilled = 0;   ///< sealed receivers that took the values of their neighbours
    };
    struct Seconds {
        double build = 0; ///< building acceleration structures and loading textures
        double fit = 0;   ///< fitting vertices to the surface
        TraceSeconds tracing;
        double transport = 0; ///< bounces and subsurface scattering
        double all = 0;
    };
    struct Gather {
        std::size_t entries = 0, bytes = 0;
        std::size_t bytes_moved = 0; ///< bytes transferred to and from the device that applied the operator;
                                     ///< 0: the CPU applied it
    };
    struct Lamps {
        /// Number of lamps, and of their lights and emissive triangles.
        std::size_t count = 0, lights = 0, triangles = 0;
    };
    Receivers receivers;
    Fit fit;
    std::size_t rays = 0; ///< all traced rays
    std::string device;
    Seconds seconds;
    double mean_visibility = 0; ///< area-weighted mean of T_0 / Y_00 of the direct light
    /// Relative L2 error by sampling, estimated from independent samples: with `denoise` of all sky light
    /// after the noise filter, without it of direct sky light only.
    double sampling_error = 0;
    double rounding_error = 0;   ///< relative L2 error of storing float16
    double remaining_energy = 0; ///< energy of the bounces that were not computed, relative to the largest
                                 ///< transfer
    Lamps lamps;
    Gather gather;                    ///< size of the operator that applies bounces
    std::vector<std::string> notices; ///< parts of the scene that were left out or repaired, with reasons,
                                      ///< one line each

    /// All traced rays divided by the total time.
    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

/// Result of a bake.
struct BakeResult {
    BakedTransfer baked;
    /// Receivers inside geometry, which no light reaches and which are never visible; in ascending order.
    std::vector<std::uint32_t> sealed;
    BakeStatistics statistics;
    BakeNoise noise;
    std::optional<BakeErrors> errors; ///< set if they were requested
};

/// Whether a bake measures its errors over the surface. This adds the rays of some hundred receivers.
enum class MeasureErrors { no, yes };

/// Error of a bake with endless bounces: a closed room reflects all light of a lamp.
struct EndlessLampLight : Error {
    using Error::Error;
};

/// Bakes transfer for every vertex. On the CPU the result is deterministic for a given seed and does not
/// depend on the number of threads. Throws `Error` for invalid options, for a bake that does not fit into
/// memory, and if a backend is not available; `EndlessLampLight`; and `Cancelled` after a stop request.
BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress = {},
                MeasureErrors errors = MeasureErrors::no);

/// Estimates the peak memory of a bake in bytes, without the operator of its bounces, whose size is known
/// only after some receivers are traced. `numbers`: number of coefficients of a transfer vector, over all
/// terms.
double estimate_memory(const BakeOptions& options, std::size_t receivers, std::size_t triangles,
                       std::size_t numbers);

} // namespace prt
