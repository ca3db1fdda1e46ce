#pragma once

// Path-traced exit radiance at points of the surface, under an exact light and under each of the light's
// spherical-harmonic bands. Colors are linear Rec. 709. Experimental.

#include "bake/reference/distant_light.h"
#include "bake/reference/surface_points.h"
#include "prt/core/dering.h"
#include "prt/core/light.h"
#include "prt/core/transfer_layout.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace prt {

/// A distant light in exact form, and the same light as SH coefficients. If the renderer shadows suns
/// separately, direct light of these suns is excluded from the result; light of these suns after a bounce is
/// included.
struct ReferenceLight {
    DistantLight all; ///< complete light in exact form, including `suns`
    /// Light without `suns` in exact form, if the renderer adds direct light of `suns`. No value: the
    /// renderer adds no suns, and `all` is used for direct light.
    std::optional<DistantLight> sky;
    std::vector<Sun> suns; ///< suns whose direct light the renderer adds with sharp shadows; may be empty
    Light sky_bands,       ///< SH coefficients of order kMaxOrder: the complete light without `suns`
        sun_bands;         ///< SH coefficients of order kMaxOrder: `suns` alone; zero if `suns` is empty
    std::string name = {}; ///< for reports; may be empty

    /// Returns the exact light that arrives at a point without a bounce: `sky`, or `all` if `sky` has no
    /// value.
    const DistantLight& seen() const { return sky ? *sky : all; }
    /// Returns the `dering_factors` of the first `order` (1..kMaxOrder) bands of `sky_bands`. Entries from
    /// `order` on are not used. Throws the errors of `truncated` and `dering_factors`.
    BandFactors factors(int order) const;
    /// Returns the lighting for transfer of `order` bands: Lighting::sky is `sky_bands` times `factors`, and
    /// Lighting::suns is `sun_bands`, or has no value if `suns` is empty. Throws `Error` if `sky_bands` or
    /// `sun_bands` have fewer bands, or if a coefficient of the result is not finite.
    Lighting lighting(int order, const BandFactors& factors) const;
    /// Returns the lighting for transfer of `order` bands, with the sky multiplied by `factors(order)`.
    /// Throws the errors of both functions.
    Lighting lighting(int order) const { return lighting(order, factors(order)); }
};

/// Maximum number of bounces with a separate entry in `BandRadiance`. Light after more bounces is included in
/// the last entry.
inline constexpr int kCountedBounces = 8;

/// Exit radiance at one point, split by the number of bounces of the light and by its SH band.
struct BandRadiance {
    using Bands = std::array<glm::vec3, kMaxOrder>; ///< [band] radiance that the light of this band causes
    /// [bounces][band] radiance of light after exactly `bounces` bounces, 0..kCountedBounces; the last entry
    /// also includes light after more bounces.
    std::array<Bands, kCountedBounces + 1> sky{}, ///< caused by the bands of ReferenceLight::sky_bands
        suns{}; ///< caused by the bands of ReferenceLight::sun_bands; zero for 0 bounces, because the
                ///< renderer adds direct light of suns
};

/// Limits of a transfer whose exit radiance `SurfaceRadiance::under` computes.
struct BandTruncation {
    int order = 6;   ///< number of bands, 1..kMaxOrder
    int bounces = 0; ///< maximum number of bounces that are included; kEndlessBounces, or kCountedBounces and
                     ///< more: all
    BandFactors factors; ///< [band < order] factors on the bands of the sky, such as those of
                         ///< `ReferenceLight::factors`; must be set
};

/// Settings of `SurfaceRadiance`.
struct SurfaceRadianceOptions {
    int paths = 256; ///< initial number of paths per point and half, at least 1
    /// Maximum number of paths per point and half. If it is at most `paths`, the number is `paths`.
    int max_paths = 1 << 14;
    /// Target noise. The number of paths is doubled until the standard error of the mean squared error over
    /// all points, divided by the mean squared radiance, is at most this value, or until `max_paths` or
    /// `seconds` ends the doubling.
    double noise = 5e-5;
    double seconds = 0; ///< time after which the number of paths is not doubled again, seconds; 0: no limit
    std::uint64_t seed = 0x9e3779b97f4a7c15; ///< seed of the paths; the halves use `seed` and `seed` + 1
    int threads = 0;                         ///< number of threads; 0: all
};

/// Path-traced exit radiance for albedo 1 at points of a surface, in two halves with independent random
/// paths. Multiply the error against half 0 by the error against half 1: the mean of this product is the
/// squared error without a bias by path noise. `truth` and `under` of one half use the same paths, so that
/// noise mostly cancels in their difference. Surfaces scatter as in `PathTracer`; paths do not enter media.
class SurfaceRadiance {
public:
    /// Traces the paths from `points`, which must be on `scene`. Keeps no references. Throws the errors of
    /// TraceScene::rays, and `Cancelled` after a stop request.
    SurfaceRadiance(const TraceScene& scene, const SurfacePoints& points, const ReferenceLight& light,
                    const SurfaceRadianceOptions& options, const Progress& progress = {});

    /// Returns the exit radiance under the exact light with all bounces: [points]. Excludes direct light of
    /// ReferenceLight::suns. `half`: 0 or 1.
    std::span<const glm::vec3> truth(int half) const { return halves_[static_cast<std::size_t>(half)].truth; }
    /// Returns the exit radiance that the bands and bounces within the limits of `cut` cause: [points].
    /// Excludes direct light of ReferenceLight::suns. `half`: 0 or 1.
    std::vector<glm::vec3> under(const BandTruncation& cut, int half) const;
    /// Returns the exit radiance for albedo 1 by direct light of ReferenceLight::suns on the front side, with
    /// shadows: [points]. Excludes light that thin sheets transmit from their back sides.
    std::span<const glm::vec3> suns() const { return suns_; }

private:
    struct Half {
        std::vector<glm::vec3> truth;    ///< [points]
        std::vector<BandRadiance> bands; ///< [points]
    };
    std::array<Half, 2> halves_;
    std::vector<glm::vec3> suns_;
};

} // namespace prt
