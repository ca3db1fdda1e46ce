#pragma once

// Radiance at points of the surface by path tracing, under a light as it is and as so many bands hold it.
// Experimental.

#include "prt/dering.h"
#include "prt/distant_light.h"
#include "prt/sun_disc.h"
#include "prt/surface_points.h"
#include "prt/transfer_layout.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace prt {

/// A light as it is, and as coefficients.
struct MeasuredLight {
    DistantLight all;                ///< lights what is lit after a bounce
    std::optional<DistantLight> sky; ///< lights surfaces, where `suns` are left to the renderer; else `all`
    std::vector<SunDisc> suns;       ///< that the renderer adds by sharp shadows
    Light sky_bands, sun_bands;      ///< of kMaxOrder: without `suns`, and of them

    const DistantLight& seen() const { return sky ? *sky : all; }
};

/// Bounces that are told apart; light of more is together.
inline constexpr int kCountedBounces = 8;

/// What the bands of a sky and of suns give after so many bounces.
struct BandRadiance {
    using Bands = std::array<glm::vec3, kMaxOrder>;
    std::array<Bands, kCountedBounces + 1> sky{}, suns{}; ///< [bounces]; suns light what is lit after one
};

/// What transfer of an order and of so many bounces could hold.
struct BandCut {
    int order = 6;
    int bounces = 0;     ///< or kEndlessBounces; from kCountedBounces on it is the same
    BandFactors factors; ///< of the sky's bands, by `deringed`
};

struct SurfaceRadianceOptions {
    int paths = 256; ///< from each point, in each half, at least
    int most_paths = 1 << 14;
    /// Twice as many again as long as the mean over all points of a squared difference, relative to the
    /// radiance, has a larger standard error by noise.
    double noise = 5e-5;
    double seconds = 0; ///< after which there are no more, whatever their noise; 0: any
    std::uint64_t seed = 0x9e3779b97f4a7c15;
    int threads = 0; ///< 0: all
};

/// Exit radiance for albedo 1 at points, twice and independently, so that a product of differences from both
/// has no noise in the mean. Lights of the bands and the light itself have the same paths: what they differ
/// by is known far better than either. Surfaces are as `PathTracer` takes them; media are not entered.
class SurfaceRadiance {
public:
    /// Throws `Cancelled` when asked to stop.
    SurfaceRadiance(const TraceScene& scene, const SurfacePoints& points, const MeasuredLight& light,
                    const SurfaceRadianceOptions& options, const Progress& progress = {});

    /// All bounces of the light itself, but direct light of suns that the renderer adds. [points]
    std::span<const glm::vec3> truth(int half) const { return halves_[static_cast<std::size_t>(half)].truth; }
    /// What the cut leaves of that. [points]
    std::vector<glm::vec3> under(const BandCut& cut, int half) const;
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
