#pragma once

// Compressed volumes on the GPU. An OpenGL 4.5 context must be current for all functions.

#include "prt/core/volume_relighter.h"
#include "runtime/render/gl/gl_objects.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// A volume on the GPU as three textures (prt/core/volume_relighter.h), for shaders that include
/// `shaders/prt_volume.glsl`. The compute shader `shaders/prt_volume.comp` computes the light texture.
class GlVolume {
public:
    /// Uploads all data that do not depend on the lighting. Keeps a reference to `volume`, whose weights must
    /// be packed. `format`: format of the light texture, which filters linearly for rgba16 and does not
    /// filter for rgba32. The light is undefined until `set_light` or `upload`. Throws `Error` if GPU memory
    /// runs out, if the device does not support 3D textures of this size, if a probe has more words than
    /// shaders support, or if the driver cannot build the program. Throws the errors of the constructors of
    /// VolumeRelighter and VolumeLookup.
    explicit GlVolume(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16);

    /// Computes the light texture for `lighting` on the GPU. `sun`: unit direction towards a sun, whose
    /// visibility at each probe is computed, 0..1. The visibility is 0 if `sun` has no value, or if the
    /// transfer has no `direct` term. Magnitudes above 65 504 become 65 504, in both formats. Changes the
    /// program in use and the bound storage buffers and image units. Throws the errors of
    /// `ClusterLighting::update`.
    void set_light(const Lighting& lighting, const std::optional<glm::vec3>& sun = {});
    /// Uploads a light texture that the CPU computed, instead of `set_light`. `texels`: result of
    /// relighter().update, [relighter().bytes()]. Throws `Error` if OpenGL reports an error.
    void upload(std::span<const std::byte> texels);
    /// Binds the light, visibility and index textures to the texture units PRT_UNIT_VOLUME_* of
    /// shaders/shared_layout.h for subsequent draws.
    void bind() const;
    /// Returns the object that computes the constants of the volume, and that can compute its light texture
    /// on the CPU. Valid as long as this object.
    const VolumeRelighter& relighter() const { return relighter_; }
    /// Returns the light texture as floats: [planes · depth][height][width], the size
    /// relighter().atlas().light_texels(). Waits for the GPU. Throws `Error` if OpenGL reports an error.
    std::vector<glm::vec4> read() const;
    /// Returns the size of all data on the GPU in bytes: weights, clusters, constants, indices of the probes
    /// of each brick, and the three textures.
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
