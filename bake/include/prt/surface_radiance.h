#pragma once

// Path-traced radiance at points of the surface, under a light in exact form and under each of its
// spherical-harmonic bands. Experimental.

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
    DistantLight all; ///< complete light, which lights surfaces that paths reach after a bounce
    /// Light of the first surface of a path, if the renderer adds `suns`; no value: `all`.
    std::optional<DistantLight> sky;
    std::vector<Sun> suns; ///< suns that the renderer adds with sharp shadows
    /// SH coefficients of order kMaxOrder: light without `suns`, and light of the suns.
    Light sky_bands, sun_bands;
    std::string name = {}; ///< for reports; may be empty

    /// Returns the light of the first surface of a path.
    const DistantLight& seen() const { return sky ? *sky : all; }
    /// Returns the factors of `deringed` on the bands of the sky at this order.
    BandFactors factors(int order) const;
    /// Returns the lighting for transfer of this order, with `factors` on the bands of the sky. Suns are in
    /// the sky unless they are separate.
    Lighting lighting(int order, const BandFactors& factors) const;
    /// Returns the lighting with `factors(order)`.
    Lighting lighting(int order) const { return lighting(order, factors(order)); }
};

/// Number of bounces that are stored separately; later bounces are added to the last entry.
inline constexpr int kCountedBounces = 8;

/// Radiance that each band of the sky and of the suns contributes, for each number of bounces.
struct BandRadiance {
    using Bands = std::array<glm::vec3, kMaxOrder>;
    /// [bounces][bands]; suns contribute only after at least one bounce.
    std::array<Bands, kCountedBounces + 1> sky{}, suns{};
};

/// Order and number of bounces that transfer is limited to.
struct BandTruncation {
    int order = 6;
    int bounces = 0;     ///< number of bounces, or kEndlessBounces; kCountedBounces and more are equivalent
    BandFactors factors; ///< factors on the bands of the sky, from `dering_factors`
};

/// Settings of `SurfaceRadiance`.
struct SurfaceRadianceOptions {
    int paths = 256; ///< minimum number of paths per point and half
    int max_paths = 1 << 14;
    /// Target noise: the number of paths is doubled until the standard error of the mean squared relative
    /// difference is below this.
    double noise = 5e-5;
    double seconds = 0; ///< time after which the number of paths is not doubled again, seconds; 0: no limit
    std::uint64_t seed = 0x9e3779b97f4a7c15;
    int threads = 0; ///< number of threads; 0: all
};

/// Exit radiance for albedo 1 at points, in two independent halves: the product of an error against one half
/// and an error against the other has no noise in its mean. The exact light and its bands use the same paths,
/// so that their difference is far more precise than either value. Surfaces scatter as in `PathTracer`; paths
/// do not enter media.
class SurfaceRadiance {
public:
    /// Traces the paths. Throws `Cancelled` after a stop request.
    SurfaceRadiance(const TraceScene& scene, const SurfacePoints& points, const ReferenceLight& light,
                    const SurfaceRadianceOptions& options, const Progress& progress = {});

    /// Returns the radiance by all bounces of the exact light, without direct light of suns that the renderer
    /// adds: [points]. `half`: 0 or 1.
    std::span<const glm::vec3> truth(int half) const { return halves_[static_cast<std::size_t>(half)].truth; }
    /// Returns the radiance by the bands and bounces of `cut`: [points]. `half`: 0 or 1.
    std::vector<glm::vec3> under(const BandTruncation& cut, int half) const;
    /// Returns the radiance by direct light of the suns that the renderer adds: [points].
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
