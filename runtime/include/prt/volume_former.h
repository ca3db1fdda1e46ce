#pragma once

// The per-lighting work of a game with a volume: incident light of all probes, as a texture takes it.
//
//     VolumeFormer former(volume);                                  // once per model
//     std::vector<glm::vec4> constants(former.rows());
//     std::vector<std::byte> texels(former.bytes());
//     former.form_constants(light, towards_sun, constants);         // when the lighting changes
//     former.form(constants, texels);                               // then upload
//
// Experimental.

#include "prt/constant_former.h"
#include "prt/volume_textures.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

enum class VolumeFormat {
    rgba16, ///< half floats, -65 504 to 65 504
    rgba32, ///< floats, which not every GPU filters
};

/// Thread-safe. Allocates when it is made alone; `form` starts threads where it may have more than one.
class VolumeFormer {
public:
    /// Keeps a reference to `volume`, whose weights are packed.
    explicit VolumeFormer(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16);

    const TransferLayout& layout() const { return constants_.layout(); }
    const VolumeAtlas& atlas() const { return atlas_; }
    /// Constants in all: those of ConstantFormer.
    std::size_t rows() const { return constants_.rows(); }
    std::size_t probes() const { return first_texels_.size() - 1; }
    /// Of the texture of light.
    std::size_t bytes() const;

    /// Writes what ConstantFormer does to `constants` [rows], and how much of a sun in unit direction `sun`
    /// is seen into `w` of output 0: 0 where there is no sun, or no `direct` part, without which suns are in
    /// the transfer. Throws `Error` as ConstantFormer does.
    void form_constants(const LightingView& lighting, const std::optional<glm::vec3>& sun,
                        std::span<glm::vec4> constants) const;

    /// Writes texels of all probes to `texels` [bytes()]; those of no brick are left as they are.
    void form(std::span<const glm::vec4> constants, std::span<std::byte> texels, int threads = 0) const;
    /// The same of probes [first, last), to spread the work over threads or frames.
    void form_probes(std::span<const glm::vec4> constants, std::size_t first, std::size_t last,
                     std::span<std::byte> texels) const;

private:
    const CompressedVolume& volume_;
    VolumeFormat format_;
    VolumeAtlas atlas_;
    ConstantFormer constants_;
    std::vector<ClusterLayout> clusters_;
    std::vector<float> direct_;               ///< [rows / outputs][order²] of output 0
    std::vector<std::uint32_t> first_texels_; ///< [probes + 1]
    std::vector<std::uint32_t> texels_;       ///< of each probe in turn
};

} // namespace prt
