#include "core/texel_light.h"

#include "prt/lightmap_file.h"

#include <algorithm>

namespace viewer {
namespace {

/// What filters read at `vertices`, as texels of the layout; vertices without a triangle read nothing.
std::vector<prt::BilinearTexels> filters_at(const LoadedModel& loaded,
                                            std::span<const std::uint32_t> vertices) {
    const prt::Scene& scene = loaded.model->scene;
    const prt::LightmapLayout& layout = *loaded.lightmap.layout();
    const std::vector<std::size_t> first = layout.first_texels();
    std::vector<const prt::LightmapPlace*> places(scene.vertex_arrays.size());
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        places[scene.primitives[p].vertices] = &layout.places[p];
    std::vector<prt::BilinearTexels> filters;
    for (const std::uint32_t vertex : vertices) {
        prt::BilinearTexels& filter = filters.emplace_back(prt::BilinearTexels{});
        for (std::size_t a = 0; a < places.size(); ++a) {
            const prt::VertexArray& array = scene.vertex_arrays[a];
            if (!places[a] || vertex < array.first_receiver || vertex >= array.first_receiver + array.size())
                continue;
            const prt::LightmapSize& map = layout.maps[places[a]->map];
            const glm::vec2 uv =
                array.texcoords[static_cast<std::size_t>(places[a]->texcoord)][vertex - array.first_receiver];
            filter = prt::bilinear_texels(map, static_cast<double>(uv.x) * map.width,
                                          static_cast<double>(uv.y) * map.height);
            for (std::uint32_t& texel : filter.texels)
                texel += static_cast<std::uint32_t>(first[places[a]->map]);
        }
    }
    return filters;
}

/// Of texels in ascending order; black where a bake has none.
std::vector<glm::vec3> radiance_of(const LoadedModel& loaded, const prt::Lighting& lighting,
                                   std::span<const std::uint32_t> texels) {
    if (loaded.compressed)
        return prt::exit_radiance(prt::picked_texels(*loaded.compressed, texels), lighting, 1);
    const std::vector<glm::vec3> columns = prt::light_columns(loaded.raw->layout, lighting);
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t texel : texels) {
        const auto receiver = receiver_of(loaded.lightmap.baked->texels, texel);
        radiance.push_back(
            receiver ? prt::exit_radiance(loaded.raw->vector(*receiver), loaded.raw->layout, columns)
                     : glm::vec3(0));
    }
    return radiance;
}

} // namespace

std::vector<glm::vec3> texel_radiance_at(const LoadedModel& loaded, const prt::Lighting& lighting,
                                         std::span<const std::uint32_t> vertices) {
    const std::vector<prt::BilinearTexels> filters = filters_at(loaded, vertices);
    std::vector<std::uint32_t> texels;
    for (const prt::BilinearTexels& filter : filters)
        texels.insert(texels.end(), std::begin(filter.texels), std::end(filter.texels));
    std::ranges::sort(texels);
    texels.erase(std::unique(texels.begin(), texels.end()), texels.end());
    const std::vector<glm::vec3> of_texels = radiance_of(loaded, lighting, texels);
    std::vector<glm::vec3> radiance;
    for (const prt::BilinearTexels& filter : filters) {
        glm::vec3& sum = radiance.emplace_back(0);
        for (std::size_t i = 0; i < 4; ++i)
            sum += static_cast<float>(filter.weights[i]) * of_texels[*receiver_of(texels, filter.texels[i])];
    }
    return radiance;
}

std::optional<std::size_t> receiver_of(std::span<const std::uint32_t> texels, std::uint32_t texel) {
    const auto at = std::ranges::lower_bound(texels, texel);
    if (at == texels.end() || *at != texel)
        return std::nullopt;
    return static_cast<std::size_t>(at - texels.begin());
}

} // namespace viewer
