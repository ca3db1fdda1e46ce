#pragma once

// The work of a game with a volume when the lighting changes: computes the incident light at all probes, as
// the light texture; also the layout of the textures of a volume.
//
//     VolumeRelighter relighter(volume);                                  // once per model
//     std::vector<glm::vec4> constants(relighter.rows());
//     std::vector<std::byte> texels(relighter.bytes());
//     relighter.update_constants(light, towards_sun, constants);         // when the lighting changes
//     relighter.update(constants, texels);                               // then upload
//
// Experimental.

#include "prt/core/cluster_lighting.h"
#include "prt/core/transfer_volume.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Number of texels along a side of a 3D texture that every implementation of OpenGL 3.3 and ES 3.0 supports.
/// The light and visibility textures of a VolumeAtlas never exceed it along x and y. Along z they can: a
/// light texture of order 3 exceeds it from 18 208 bricks on.
inline constexpr int kGuaranteedTexels = 256;

/// Positions of the bricks of a volume in its light and visibility textures.
struct VolumeAtlas {
    /// Number of bricks along each axis of one plane. Brick b of VolumeGrid::bricks is at
    /// (b mod x, b / x mod y, b / (x y)), in bricks; x, y and z are the components of `bricks`.
    glm::ivec3 bricks{0};
    int order = 0; ///< order of incident light, 2 to kMaxIncidentOrder; 0 only before initialisation

    /// Returns the number of SH coefficients of a probe, order².
    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(order)); }
    /// Returns the number of planes of the light texture. Each plane contains four numbers of every probe. A
    /// probe has three numbers per SH coefficient, and one for the sun.
    int planes() const { return (3 * coefficient_count(order) + 1 + 3) / 4; }
    /// Returns width, height and depth of the visibility texture in texels. One plane of the light texture
    /// has the same size.
    glm::ivec3 visibility_texels() const { return kBrickSide * bricks; }
    /// Returns width, height and depth of the light texture in texels, with all planes stacked along z.
    glm::ivec3 light_texels() const { return visibility_texels() * glm::ivec3(1, 1, planes()); }
    /// Returns the number of texels of one plane of the light texture, including texels without a brick.
    std::size_t texels_of_plane() const;
    /// Returns the texel of probe `i` of brick `brick` as an index into a plane [depth][height][width].
    /// `brick` is an index into VolumeGrid::bricks. `i` is 0 to kBrickProbes - 1; x varies fastest, then y,
    /// then z.
    std::size_t texel(std::size_t brick, std::size_t i) const;

    friend bool operator==(const VolumeAtlas&, const VolumeAtlas&) = default;
};

/// Returns the atlas for all bricks of `grid`. `order`: number of bands of incident light, 2 to
/// kMaxIncidentOrder.
VolumeAtlas atlas_of(const VolumeGrid& grid, int order);

/// Builds the visibility texture, [texels_of_plane()][2]. `probes`: probes_of(grid); `visibility`: [probes].
/// Four bytes of word 0, lowest first: the stored visibility distances along -x, +x, -y and +y. Four bytes of
/// word 1: the distances along -z and +z, the level of the probe minus the level of the brick, and a flag.
/// The flag belongs to the cell whose minimum corner is this probe. The flag is 1 if all eight probes of the
/// cell see the whole cell, so that shaders use trilinear weights there. Otherwise, and if the brick has no
/// cell at this corner, the flag is 0. Texels without a brick are 0.
std::vector<std::uint32_t> visibility_texels(const VolumeGrid& grid, const VolumeProbes& probes,
                                             std::span<const ProbeVisibility> visibility);

/// Builds the index texture, [size.z][size.y][size.x] with `size` of `grid`: 4 · brick + level of the brick,
/// or VolumeLookup::kNoBrick if no brick covers the entry. `index`: result of VolumeLookup::index for `grid`.
std::vector<std::uint32_t> index_texels(const VolumeGrid& grid, std::span<const std::uint32_t> index);

/// Number format of the four channels of a texel of the light texture.
enum class VolumeFormat {
    rgba16, ///< RGBA16F, 8 bytes per texel; magnitudes above 65 504 become 65 504
    rgba32, ///< RGBA32F, 16 bytes per texel; some GPUs cannot filter such textures
};

/// Computes the light texture of a volume for a lighting. Immutable and thread-safe. After construction it
/// allocates no memory, except that `update` starts threads unless its parameter `threads` is 1.
class VolumeRelighter {
public:
    /// Prepares the light texture of `volume` in the given format. Keeps a reference to `volume`, which must
    /// outlive the relighter. Requires a grid that `check_grid` accepts, and packed weights. Throws `Error`
    /// if bricks of the volume overlap, or if the layout of its transfer is invalid.
    explicit VolumeRelighter(const CompressedVolume& volume, VolumeFormat format = VolumeFormat::rgba16);

    /// Layout of the transfer vectors of the volume, reduced to one output (`TransferLayout::of_one_output`).
    const TransferLayout& layout() const { return constants_.layout(); }
    /// Positions of the bricks in the light texture, and the size of this texture.
    const VolumeAtlas& atlas() const { return atlas_; }
    /// Number of constants, `ClusterLighting::rows()`: for each row of the bases, one per coefficient of
    /// incident light.
    std::size_t rows() const { return constants_.rows(); }
    /// Number of probes of the volume.
    std::size_t probes() const { return first_texels_.size() - 1; }
    /// Size of the light texture in bytes: all planes of `atlas()`, in the format passed to the constructor.
    std::size_t bytes() const;

    /// Computes the constants for `lighting` and writes them to `constants` [rows() or more]: r, g, b are
    /// those of `ClusterLighting::update`. For output 0, w is the response of the row to a sun in unit
    /// direction `sun`, from which `update` computes the visibility of this sun at each probe. For other
    /// outputs, w is 0. All w are 0 if `sun` has no value, and if the transfer has no `direct` term, because
    /// suns then light all of its terms. Throws the errors of `ClusterLighting::update`.
    void update_constants(const LightingView& lighting, const std::optional<glm::vec3>& sun,
                          std::span<glm::vec4> constants) const;

    /// Computes the light texture from the `constants` [rows()] of `update_constants`, and writes it to
    /// `texels` [bytes()]: for each probe the coefficients of incident light, then the visibility of the sun,
    /// 0..1, then zeros up to the end of the last plane. Texels that belong to no brick are not changed.
    /// `threads`: number of threads; 0: all hardware threads.
    void update(std::span<const glm::vec4> constants, std::span<std::byte> texels, int threads = 0) const;
    /// Computes, like `update`, only the texels of the probes with indices `first` .. `last` - 1, in the
    /// calling thread, and does not change other texels. The caller can spread the probes over threads or
    /// frames. Requires last <= probes().
    void update_probes(std::span<const glm::vec4> constants, std::size_t first, std::size_t last,
                       std::span<std::byte> texels) const;

private:
    const CompressedVolume& volume_;
    VolumeFormat format_;
    VolumeAtlas atlas_;
    ClusterLighting constants_;
    std::vector<ClusterLayout> clusters_;
    /// [rows / outputs][layout().order²] `direct` coefficients of output 0, grey; empty without a `direct`
    /// term
    std::vector<float> direct_;
    std::vector<std::uint32_t> first_texels_; ///< [probes + 1] first entry of each probe in `texels_`
    std::vector<std::uint32_t> texels_; ///< indices of the texels of each probe in a plane, probe by probe
};

} // namespace prt
