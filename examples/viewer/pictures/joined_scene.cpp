// Joins two scenes for path tracing.

#include "pictures/joined_scene.h"

#include <initializer_list>

namespace viewer {
namespace {

/// Returns the material with its image indices increased by `images`.
prt::Material behind(prt::Material material, int images) {
    for (prt::TextureUse* use :
         {&material.base_color_texture, &material.metal.texture, &material.transmission.factor_texture,
          &material.transmission.color_texture, &material.glass.texture, &material.emission.texture})
        if (use->image >= 0)
            use->image += images;
    return material;
}

} // namespace

void join(prt::Scene& scene, const prt::Scene& other) {
    const std::size_t arrays = scene.vertex_arrays.size(), materials = scene.materials.size(),
                      receivers = scene.receivers();
    for (const prt::Material& material : other.materials)
        scene.materials.push_back(behind(material, static_cast<int>(scene.images.size())));
    scene.images.insert(scene.images.end(), other.images.begin(), other.images.end());
    for (prt::VertexArray vertices : other.vertex_arrays) {
        vertices.first_receiver += receivers;
        scene.vertex_arrays.push_back(std::move(vertices));
    }
    for (prt::Primitive primitive : other.primitives) {
        primitive.vertices += arrays;
        primitive.material += materials;
        scene.primitives.push_back(std::move(primitive));
    }
}

prt::Scene joined(prt::Scene scene, const prt::Scene& other) {
    join(scene, other);
    return scene;
}

} // namespace viewer
