#pragma once

// Radiance at points of the surface by path tracing, under the exact light and under its spherical-harmonic
// bands. Experimental.

#include "prt/dering.h"
#include "prt/distant_light.h"
#include "prt/sun.h"
#include "prt/surface_points.h"
#include "prt/transfer_layout.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// A light in exact form and as coefficients.
struct ReferenceLight {
    DistantLight all;                ///< lights everything that is lit after a bounce
    std::optional<DistantLight> sky; ///< lights surfaces directly if `suns` are left to the renderer;
                                     ///< otherwise `all`
    std::vector<Sun> suns;           ///< suns that the renderer adds with sharp shadows
    Light sky_bands, sun_bands;      ///< of order kMaxOrder: light without `suns`, and light of the suns
    std::string name = {};           ///< for reports; may be empty

    /// Light that paths use at the first surface.
    const DistantLight& seen() const { return sky ? *sky : all; }
    /// Returns the factors of `deringed` on the bands of the sky at this order.
    BandFactors factors(int order) const;
    /// Returns the lighting for transfer of this order, with `factors` on the bands of the sky. Suns are in
    /// the sky unless they are separate.
    Lighting lighting(int order, const BandFactors& factors) const;
    Lighting lighting(int order) const { return lighting(order, factors(order)); }
};

/// Bounces stored separately; later ones share the last entry.
inline constexpr int kCountedBounces = 8;

/// Radiance from each band of a sky and of suns, by number of bounces.
struct BandRadiance {
    using Bands = std::array<glm::vec3, kMaxOrder>;
    std::array<Bands, kCountedBounces + 1> sky{}, suns{}; ///< [bounces]; suns count only after at least one
                                                          ///< bounce
};

/// Order and number of bounces that transfer is limited to.
struct BandTruncation {
    int order = 6;
    int bounces = 0;     ///< number of bounces, or kEndlessBounces; kCountedBounces and more are equivalent
    BandFactors factors; ///< factors on the sky's bands, from `deringed`
};

struct SurfaceRadianceOptions {
    int paths = 256; ///< minimum number of paths from each point in each half
    int max_paths = 1 << 14;
    /// Paths are doubled until the standard error of the mean squared relative difference is below this.
    double noise = 5e-5;
    double seconds = 0; ///< time limit for doubling the number of paths, regardless of noise; 0: none
    std::uint64_t seed = 0x9e3779b97f4a7c15;
    int threads = 0; ///< number of threads; 0: all
};

/// Exit radiance for albedo 1 at points, in two independent halves, so that a product of differences from
/// both has no noise in its mean. The light and its bands use the same paths, so that their difference is far
/// more precise than either value. Surfaces scatter as in `PathTracer`; paths do not enter media.
class SurfaceRadiance {
public:
    /// Throws `Cancelled` when asked to stop.
    SurfaceRadiance(const TraceScene& scene, const SurfacePoints& points, const ReferenceLight& light,
                    const SurfaceRadianceOptions& options, const Progress& progress = {});

    /// Radiance from all bounces of the exact light, without direct light of suns that the renderer adds.
    /// [points]
    std::span<const glm::vec3> truth(int half) const { return halves_[static_cast<std::size_t>(half)].truth; }
    /// Radiance that remains within `cut`. [points]
    std::vector<glm::vec3> under(const BandTruncation& cut, int half) const;
    /// Direct light of the suns that the renderer adds. [points]
    std::span<const glm::vec3> suns() const { return suns_; }

private:
    struct Half {
        std::vector<glm::vec3> truth;
        std::vector<BandRadiance> bands;
    };
    std::array<Half, 2> halves_;
    std::vector<glm::vec3> suns_;
};

} // namespace prt
