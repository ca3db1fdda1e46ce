#pragma once

// The per-lighting work of a game with a volume: computes incident light of all probes as a texture.
//
//     VolumeRelighter relighter(volume);                                  // once per model
//     std::vector<glm::vec4> constants(relighter.rows());
//     std::vector<std::byte> texels(relighter.bytes());
//     relighter.update_constants(light, towards_sun, constants);         // when the lighting changes
//     relighter.update(constants, texels);                               // then upload
//
// Experimental.

#include "prt/cluster_lighting.h"
#include "prt/volume_textures.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Format of the light texture.
enum class VolumeFormat {
    rgba16, ///< half floats, -65 504 to 65 504
    rgba32, ///< floats, which some GPUs cannot filter
};

/// Computes volume textures. Thread-safe. Allocates only in the constructor; `update` starts threads unless
/// `threads` is 1.
class VolumeRelighter {
public:
    /// Keeps a reference to `volume`, whose weights must be packed.
    explicit VolumeRelighter(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16);

    const TransferLayout& layout() const { return constants_.layout(); }
    const VolumeAtlas& atlas() const { return atlas_; }
    /// Number of constants, as for ClusterLighting.
    std::size_t rows() const { return constants_.rows(); }
    std::size_t probes() const { return first_texels_.size() - 1; }
    /// Size of the light texture in bytes.
    std::size_t bytes() const;

    /// Computes the constants as ClusterLighting does and writes them to `constants` [rows]. The `w` of the
    /// constants of output 0 is the visibility of a sun in unit direction `sun`. It is 0 without a sun, and
    /// without a `direct` term, because all transfer then includes suns. Throws `Error` if the lighting has
    /// too few bands.
    void update_constants(const LightingView& lighting, const std::optional<glm::vec3>& sun,
                          std::span<glm::vec4> constants) const;

    /// Computes the texels of all probes and writes them to `texels` [bytes()]. Texels outside bricks are not
    /// changed.
    void update(std::span<const glm::vec4> constants, std::span<std::byte> texels, int threads = 0) const;
    /// Writes the texels of probes [first, last), to spread the work over threads or frames.
    void update_probes(std::span<const glm::vec4> constants, std::size_t first, std::size_t last,
                       std::span<std::byte> texels) const;

private:
    const CompressedVolume& volume_;
    VolumeFormat format_;
    VolumeAtlas atlas_;
    ClusterLighting constants_;
    std::vector<ClusterLayout> clusters_;
    std::vector<float> direct_;               ///< [rows / outputs][order²] of output 0
    std::vector<std::uint32_t> first_texels_; ///< [probes + 1] first entry of each probe in `texels_`
    std::vector<std::uint32_t> texels_;       ///< texels of each probe, probe after probe
};

} // namespace prt
