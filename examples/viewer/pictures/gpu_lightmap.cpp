// Relights raw lightmap transfer with compute shaders.

#include "pictures/gpu_lightmap.h"

#include "shared_layout.h"
#include "shared_viewer.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace viewer {
namespace {

/// Returns for each map the receivers of its texels, or of a texel near them.
std::vector<prt::GlObject> nearest_of_maps(const prt::BakedLightmap& lightmap) {
    const std::vector<std::size_t> first = lightmap.layout.first_texels();
    std::vector<prt::GlObject> buffers;
    auto begin = lightmap.texels.begin();
    for (std::size_t m = 0; m < lightmap.layout.maps.size(); ++m) {
        const auto end = std::lower_bound(begin, lightmap.texels.end(), first[m + 1]);
        std::vector<std::uint32_t> of_map(begin, end);
        for (std::uint32_t& texel : of_map)
            texel -= static_cast<std::uint32_t>(first[m]);
        std::vector<std::uint32_t> nearest = prt::nearest_receivers(lightmap.layout.maps[m], of_map);
        for (std::uint32_t& receiver : nearest)
            receiver += static_cast<std::uint32_t>(begin - lightmap.texels.begin());
        buffers.push_back(of_map.empty() ? prt::GlObject()
                                         : prt::make_buffer(std::span<const std::uint32_t>(nearest)));
        begin = end;
    }
    return buffers;
}

GLuint groups(int texels) {
    return static_cast<GLuint>(texels + 7) / 8;
}

} // namespace

RawLightmap::RawLightmap(std::shared_ptr<const prt::BakedLightmap> lightmap, std::size_t max_receivers)
    : lightmap_(std::move(lightmap)), transfer_(lightmap_->baked.transfer, max_receivers),
      program_(prt::make_compute_program("viewer_spread_texels.comp")), nearest_(nearest_of_maps(*lightmap_)),
      maps_(prt::make_lightmap_textures(lightmap_->layout)) {}

void RawLightmap::set_light(const prt::Lighting& lighting) {
    transfer_.set_light(lighting);
    glUseProgram(program_.name());
    prt::bind_storage(PRT_BINDING_RAW_RADIANCE, transfer_.radiance());
    for (std::size_t m = 0; m < maps_.size(); ++m) {
        if (nearest_[m].name() == 0)
            continue;
        const prt::LightmapSize& size = lightmap_->layout.maps[m];
        prt::bind_storage(PRT_BINDING_TEXEL_RECEIVERS, nearest_[m]);
        glBindImageTexture(PRT_IMAGE_TEXELS, maps_[m].name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
        glDispatchCompute(groups(size.width), groups(size.height), 1);
    }
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    for (const prt::GlObject& map : maps_)
        glGenerateTextureMipmap(map.name());
}

std::vector<prt::GlObject> make_unfiltered_maps(const prt::LightmapLayout& layout,
                                                std::span<const glm::vec3> colors) {
    std::vector<prt::GlObject> maps = prt::make_lightmap_textures(layout, colors);
    for (const prt::GlObject& map : maps) {
        glTextureParameteri(map.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(map.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    return maps;
}

} // namespace viewer
