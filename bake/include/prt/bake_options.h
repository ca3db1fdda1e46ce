#pragma once

// Options of a bake.

#include "prt/baked_transfer.h"
#include "prt/subsurface.h"
#include "prt/texture.h"
#include "prt/tracer_choice.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// Treatment of sealed receivers: receivers that no light can reach because they are inside solid geometry.
enum class Inside {
    refill, ///< replace the transfer of sealed receivers by the mean of their neighbours in the mesh, ring by
            ///< ring, which avoids dark seams where solids meet; a receiver that is connected only to sealed
            ///< receivers stays dark
    keep,   ///< leave sealed receivers dark
};

/// Points of a surface where a bake measures light.
enum class FitMode {
    automatic, ///< `surface` if test points between the vertices show that it has a lower error, otherwise
               ///< `vertex`; always `vertex` for BakeMethod::raster or with a target error
    vertex,    ///< measure light at the vertices
    surface,   ///< measure light at samples between the vertices; vertex values are then a least-squares fit
               ///< of their interpolation to the samples (Kavan, Bargteil and Sloan 2011); not supported for
               ///< BakeMethod::raster or with a target error
};

/// Value for a number of bounces: bounce light until the remaining light is negligible.
inline constexpr int kEndlessBounces = -1;
/// Maximum of a finite number of bounces. Endless bounces through media also stop at this number.
inline constexpr int kMaxBounces = 10000;
inline constexpr int kMaxRays = 1 << 24; ///< maximum number of rays per receiver

/// Assigns a medium to materials of the scene.
struct MediumChoice {
    std::string material; ///< name of the materials that get the medium; empty: all materials
    Medium medium;        ///< medium inside the surfaces with these materials, coefficients in 1/m
};

/// Settings of subsurface scattering.
struct SubsurfaceOptions {
    /// Media that replace the media of the scene's materials. If several entries match a material, the last
    /// one applies. A bake throws `Error` if no material matches an entry.
    std::vector<MediumChoice> media;
    /// Length of the scene's unit in metres, finite and greater than 0. It scales the coefficients of all
    /// media, which are in 1/m.
    double metres_per_unit = 1;
};

/// Selects the light of lamps that is baked. Lamps are lights of KHR_lights_punctual and emissive materials.
enum class LampMode {
    all,      ///< direct light of lamps, and their light after bounces
    indirect, ///< light of lamps after at least one bounce or through a medium, for renderers that add the
              ///< direct light of lamps themselves
    none,     ///< no light of lamps: the transfer has no lamp terms
};

/// Group of lamps that are dimmed together and share one term of the transfer. A bake throws `Error` if no
/// lamp belongs to the group, except with LampMode::none.
struct LampGroup {
    /// `name`: name of the term, which must differ from the names of lamps outside the group. `pattern`:
    /// matches whole names of lamps, with regard to case; * matches any number of characters, ? matches one.
    std::string name, pattern;
};

/// Settings for lamps.
struct LampOptions {
    LampMode mode = LampMode::all;
    /// Groups of lamps. A lamp belongs to the first group whose pattern matches its name. Each other lamp
    /// name gets its own term. A bake throws `Error` for more than kMaxLamps terms.
    std::vector<LampGroup> groups;
    /// Radius of point lights and spot lights in metres, finite and at least 0. A larger radius makes their
    /// shadows softer; 0: hard shadows.
    double radius = 0;
    /// Approximate number of rays, 1..kMaxRays, from a receiver to all emissive surfaces of a lamp term, and
    /// the same number to all its point and spot lights together if `radius` is greater than 0. A light
    /// without extent gets one ray.
    int rays = 64;
};

/// Treatment of faults in a scene, and of noise.
struct Repairs {
    BadTextures bad_textures = BadTextures::error; ///< treatment of missing and damaged textures
    Inside inside = Inside::refill;                ///< treatment of receivers inside solid geometry
    /// True: filter the light of receivers over the surface, as strongly as its noise requires. Depth maps
    /// (BakeMethod::raster) and surface fits do not use this filter.
    bool denoise = true;
};

/// Memory limit of a bake, and number format of its result.
struct BakeMemory {
    /// Limit of the estimated memory in bytes, above which a bake throws `Error`. 0: the memory of the
    /// machine, or of its container if that is smaller; no limit if the system does not report it.
    double limit = 0;
    /// Number format in which files store the transfer. No value: the bake selects float16 if its rounding
    /// error is below a tenth of the sampling error, otherwise float32.
    std::optional<TransferStorage> storage = {};
};

/// Settings of a bake.
struct BakeOptions {
    int order = 6; ///< order of the transfer, 1..kMaxOrder
    /// Number of rays per receiver, 1..kMaxRays; for BakeMethod::raster the number of directions.
    int rays = 1024;
    /// Target relative L2 error of the sky's direct light at the receivers, finite and greater than 0. The
    /// bake then chooses the number of rays of each receiver instead of `rays`, at most kMaxRays. No value:
    /// each receiver gets `rays` rays. BakeMethod::raster and FitMode::surface do not support a target error.
    std::optional<double> target_error;
    FitMode fit = FitMode::vertex; ///< points where light is measured
    /// Number of bounces, 0..kMaxBounces, or kEndlessBounces; 0: light without bounces. Must be 0 for
    /// BakeMethod::raster and with a distance fall-off.
    int bounces = 0;
    TracerChoice tracer; ///< hardware and method that trace the rays, and the distance fall-off of occlusion
    SubsurfaceOptions subsurface; ///< media inside materials
    LampOptions lamps;            ///< light of lamps
    Repairs repairs;              ///< treatment of faults and of noise
    BakeMemory memory;            ///< memory limit, and number format of the result
    int threads = 0;              ///< number of threads; 0: all
    std::uint64_t seed = 0;       ///< seed of the random directions of rays
};

/// Estimates the peak memory of a bake in bytes, from the order, the number of bounces and the presence of a
/// target error in `options`. The estimate excludes the operator of the bounces, whose size is known only
/// after some receivers are traced. `receivers`: number of receivers, including back sides; `triangles`:
/// number of triangles of the scene; `numbers`: number of coefficients of a transfer vector, over all its
/// terms and channels.
double estimate_memory(const BakeOptions& options, std::size_t receivers, std::size_t triangles,
                       std::size_t numbers);

} // namespace prt
