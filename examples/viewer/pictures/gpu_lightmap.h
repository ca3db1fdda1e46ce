#pragma once

// Lightmaps on the GPU, relit when the light changes.

#include "pictures/raw_transfer.h"

#include "runtime/render/gl/gl_relit_textures.h"

#include <memory>
#include <span>
#include <vector>

namespace viewer {

/// Raw lightmap transfer: one compute shader computes the radiance of receivers, another that of all texels.
class RawLightmap {
public:
    /// `max_receivers`: see `RawTransfer`.
    RawLightmap(std::shared_ptr<const prt::BakedLightmap> lightmap, std::size_t max_receivers);

    const prt::TransferLayout& layout() const { return transfer_.layout(); }
    void set_light(const prt::Lighting& lighting);
    prt::GlLightmapTextures textures() const { return {&lightmap_->layout, maps_}; }

private:
    std::shared_ptr<const prt::BakedLightmap> lightmap_;
    RawTransfer transfer_;
    prt::GlObject program_;
    std::vector<prt::GlObject>
        nearest_; ///< [maps] the receiver of each texel; empty: the map has no receivers
    std::vector<prt::GlObject> maps_;
};

/// Compressed lightmap transfer, relit in the same way as in games.
class LitLightmap {
public:
    explicit LitLightmap(std::shared_ptr<const prt::CompressedLightmap> lightmap)
        : lightmap_(std::move(lightmap)), lit_(*lightmap_) {}

    void set_light(const prt::Lighting& lighting) { lit_.set_light(lighting); }
    prt::GlLightmapTextures textures() const { return {&lightmap_->layout, lit_.textures()}; }

private:
    std::shared_ptr<const prt::CompressedLightmap> lightmap_;
    prt::GlRelitTextures lit_;
};

/// Creates maps of `colors` [texels of the layout] with nearest filtering.
std::vector<prt::GlObject> make_unfiltered_maps(const prt::LightmapLayout& layout,
                                                std::span<const glm::vec3> colors);

} // namespace viewer
