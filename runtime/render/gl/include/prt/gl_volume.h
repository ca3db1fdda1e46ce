#pragma once

// Compressed volumes on the GPU.

#include "prt/gl_objects.h"
#include "prt/volume_relighter.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// A volume on the GPU, lit by `shaders/prt_volume.comp`, for shaders that include `shaders/prt_volume.glsl`.
class GlVolume {
public:
    /// Uploads words, clusters, visibility and index. Keeps a reference to `volume`. Throws `Error` if memory
    /// runs out, if the device does not support 3D textures of this size, or if a probe has more words than
    /// shaders support.
    explicit GlVolume(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16);

    /// Computes the light of all probes for `lighting`, and the visibility of a sun in unit direction `sun`.
    void set_light(const Lighting& lighting, const std::optional<glm::vec3>& sun = {});
    /// Uploads a light texture that the CPU computed: the result of VolumeRelighter::update,
    /// [relighter().bytes()].
    void upload(std::span<const std::byte> texels);
    /// Binds the three textures to the units of shared_layout.h.
    void bind() const;
    const VolumeRelighter& relighter() const { return relighter_; }
    /// Reads back the light texture with all planes, [texels of the texture].
    std::vector<glm::vec4> read() const;
    /// Size on the GPU in bytes.
    std::size_t bytes() const { return bytes_; }

private:
    VolumeFormat format_;
    VolumeRelighter relighter_;
    std::vector<glm::vec4> computed_;
    GlObject program_, clusters_, constants_, words_, probes_;
    GlObject light_, visibility_, index_;
    std::size_t bytes_ = 0;
};

} // namespace prt
