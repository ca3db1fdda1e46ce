#pragma once

// The baker: transfer vectors of every receiver of a scene.

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

/// What becomes of receivers that no light can reach because they lie inside solid geometry.
enum class Inside {
    refill, ///< they take the values of their neighbours, so that no dark seams show where bodies meet
    keep,   ///< they stay dark
};

/// Where light is measured.
enum class FitMode {
    automatic, ///< where some points between vertices tell that it errs less
    vertex,    ///< at vertices
    surface,   ///< over the surface between them, and vertices take the values whose interpolation comes
               ///< nearest to that (Kavan, Bargteil and Sloan 2011)
};

/// Bounce until nothing is left.
inline constexpr int kEndlessBounces = -1;
/// More than that need not be asked for: endless bounces through media end there, too.
inline constexpr int kMostBounces = 10000;
inline constexpr int kMostRays = 1 << 24; ///< per receiver

/// A medium for the materials of that name; for all materials where the name is empty.
struct MediumChoice {
    std::string material;
    Medium medium;
};

struct SubsurfaceOptions {
    std::vector<MediumChoice> media; ///< instead of those of the materials
    double metres_per_unit = 1;      ///< size of the scene's unit
};

/// What is baked of the light of lamps: lights of KHR_lights_punctual, and materials that shine.
enum class LampMode {
    all,
    indirect, ///< bounces alone, for renderers that shadow lamps themselves
    none,
};

/// Lamps whose names match `pattern`, where * stands for any letters and ? for one, are dimmed together.
struct LampGroup {
    std::string name, pattern;
};

struct LampOptions {
    LampMode mode = LampMode::all;
    std::vector<LampGroup> groups; ///< a lamp is of the first that it matches
    double radius = 0;             ///< metres: of points and spots, whose shadows get soft by it
    int rays = 64;                 ///< from a receiver to the lamps of a name that have extent
};

/// Repairs of faults of a scene, and of noise.
struct Repairs {
    BadTextures bad_textures = BadTextures::error;
    Inside inside = Inside::refill;
    bool denoise = true; ///< light at receivers is filtered over the surface as far as it is noise
};

struct BakeMemory {
    double limit = 0; ///< bytes; 0: what the machine or its container has
    /// None: float16 where its rounding is less than a tenth of the sampling error.
    std::optional<TransferStorage> storage = {};
};

/// Relative L2 errors of what a bake wrote, noise and interpolation of all bounces, measured at points over
/// the surface.
struct BakeErrors {
    struct Error {
        double relative_l2 = 0, standard_error = 0;
        /// Root mean square, over that of the light of the whole scene.
        double of_scene = 0;
        bool known = false; ///< there are points enough, and light; else `relative_l2` is 0
    };
    struct Lamp {
        std::string name;
        Error error;
    };
    struct Node {
        std::string name;
        Error sky, lamps, backs, backs_by_lamps;
        std::size_t points = 0;
    };
    std::size_t points = 0;
    Error sky;              ///< of all its light
    Error direct, indirect; ///< without a bounce and the rest, relative to all light of a sky
    Error lamps;            ///< at the strengths of the scene
    /// Errors of the front's values on backs of two-sided surfaces, where direct light of the sky or of lamps
    /// arrives.
    Error backs, backs_by_lamps;
    std::vector<Lamp> each_lamp = {};
    std::vector<Node> nodes = {}; ///< in the order of their first primitive
};

struct BakeOptions {
    int order = 6;
    int rays = 1024;                    ///< per receiver; directions where method is raster
    std::optional<double> target_error; ///< relative L2 to reach, with as many rays as each receiver needs
    FitMode fit = FitMode::vertex;
    int bounces = 0; ///< or kEndlessBounces
    TracerChoice tracer;
    SubsurfaceOptions subsurface;
    LampOptions lamps;
    Repairs repairs;
    BakeMemory memory;
    int threads = 0; ///< 0: all
    std::uint64_t seed = 0;
};

/// Noise of rays that is left in each term of filtered light, relative L2, as halves of the rays tell it; 0
/// where that is not known.
struct BakeNoise {
    bool filtered = false;
    double sky = 0;              ///< of all light of a sky
    double direct = 0;           ///< without a bounce, over all light of a sky
    double indirect = 0;         ///< of the rest, over all light of a sky
    std::vector<double> lamps{}; ///< of the bounces of each, over its light that is written
};

struct BakeStatistics {
    /// How light was measured, and what points between vertices told of it; 0 where none was asked.
    struct Fit {
        int samples = 0;     ///< that each receiver's rays are divided among; 0: at vertices
        double between = 0;  ///< relative L2 of direct light between vertices, were these without noise
        double sampling = 0; ///< relative L2 of the rays of one receiver
    };
    struct Receivers {
        std::size_t all = 0;        ///< of the scene
        std::size_t traced = 0;     ///< those on a surface; the others have zero transfer
        std::size_t back_sides = 0; ///< traced beside them, where surfaces scatter on both sides
        std::size_t sealed = 0;     ///< inside geometry, where no light reaches
        std::size_t refilled = 0;   ///< of those, how many took the values of their neighbours
    };
    struct Seconds {
        double build = 0; ///< acceleration structures and textures
        double fit = 0;   ///< of vertices to the surface
        TraceSeconds tracing;
        double transport = 0; ///< bounces and subsurface scattering
        double all = 0;
    };
    struct Gather {
        std::size_t entries = 0, bytes = 0;
        std::size_t bytes_moved = 0; ///< to and from the device that applied it; 0: the processor did
    };
    struct Lamps {
        std::size_t count = 0, lights = 0, triangles = 0; ///< names, and what shines under them
    };
    Receivers receivers;
    Fit fit;
    std::size_t rays = 0; ///< traced in all
    std::string device;
    Seconds seconds;
    double mean_visibility = 0; ///< area-weighted T_0 / Y_00 of the direct light
    /// Estimated relative L2 error by sampling: of the light of the sky where it was filtered, else of its
    /// direct light, from independent samples.
    double sampling_error = 0;
    double rounding_error = 0;   ///< relative L2 of storing float16
    double remaining_energy = 0; ///< of the bounces that were not done, over the largest transfer
    Lamps lamps;
    Gather gather;                    ///< the operator of the bounces
    std::vector<std::string> notices; ///< what was left out or repaired, and why, a line each

    /// All rays over all time.
    double rays_per_second() const { return static_cast<double>(rays) / seconds.all; }
};

struct BakeResult {
    BakedTransfer baked;
    /// Receivers inside geometry, where no light reaches, ascending: nobody sees them.
    std::vector<std::uint32_t> sealed;
    BakeStatistics statistics;
    BakeNoise noise;
    std::optional<BakeErrors> errors; ///< where they were asked for
};

/// Whether a bake measures its errors over the surface, by some hundred receivers' rays more.
enum class MeasureErrors { no, yes };

/// Thrown for endless bounces where a closed room reflects all light of a lamp.
struct EndlessLampLight : Error {
    using Error::Error;
};

/// Bakes transfer for every vertex. On the CPU deterministic from the seed, whatever the number of threads.
/// Throws `Error` for options outside their range, for a bake that does not fit into memory, and where a
/// backend is not there; `EndlessLampLight`; `Cancelled` when asked to stop.
BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress = {},
                MeasureErrors errors = MeasureErrors::no);

/// Bytes that a bake takes at most at a time, roughly, but for the operator of its bounces, whose size is
/// found by tracing some receivers. `numbers`: of a transfer vector, all parts together.
double estimate_memory(const BakeOptions& options, std::size_t receivers, std::size_t triangles,
                       std::size_t numbers);

} // namespace prt
