#pragma once

// Lightmaps on the GPU, lit when the light changes.

#include "pictures/raw_transfer.h"

#include "prt/gl_lightmap.h"

#include <memory>
#include <span>
#include <vector>

namespace viewer {

/// As it was baked: radiance of receivers by a compute shader, and of all texels by another.
class RawLightmap {
public:
    /// `most_receivers`: as of `RawTransfer`.
    RawLightmap(std::shared_ptr<const prt::BakedLightmap> lightmap, std::size_t most_receivers);

    const prt::TransferLayout& layout() const { return transfer_.layout(); }
    void set_light(const prt::Lighting& lighting);
    prt::GlLightmapTextures textures() const { return {&lightmap_->layout, maps_}; }

private:
    std::shared_ptr<const prt::BakedLightmap> lightmap_;
    RawTransfer transfer_;
    prt::GlObject program_;
    std::vector<prt::GlObject>
        nearest_; ///< [maps] the receiver of each texel; none: the map has no receivers
    std::vector<prt::GlObject> maps_;
};

/// As games have it.
class LitLightmap {
public:
    explicit LitLightmap(std::shared_ptr<const prt::CompressedLightmap> lightmap)
        : lightmap_(std::move(lightmap)), lit_(*lightmap_) {}

    void set_light(const prt::Lighting& lighting) { lit_.set_light(lighting); }
    prt::GlLightmapTextures textures() const { return lit_.textures(); }

private:
    std::shared_ptr<const prt::CompressedLightmap> lightmap_;
    prt::GlLightmap lit_;
};

/// Maps of `colors` [texels of the layout] that are looked up unfiltered.
std::vector<prt::GlObject> make_unfiltered_maps(const prt::LightmapLayout& layout,
                                                std::span<const glm::vec3> colors);

} // namespace viewer
