// Uploads the data that depth maps are drawn from.

#include "bake/raster/raster_scene.h"

#include "bake/raster/storage_buffer.h"
#include "bake/trace_gpu/alpha_tables.h"

namespace prt {

RasterScene::RasterScene(const TraceScene& scene) : has_alpha_(scene.surfaces().traits().alpha) {
    const std::vector<std::uint32_t> triangles = shadowing_triangles(scene);
    const AlphaTables alpha = make_alpha_tables(scene, triangles);
    triangles_ = triangles.size();
    corners_ = storage_buffer(tagged_corners(scene, triangles, alpha), "the triangles");
    alpha_triangles_ = storage_buffer(alpha.triangles, "the cut-out triangles");
    alpha_materials_ = storage_buffer(alpha.materials, "the cut-out materials");
    alpha_texels_ = storage_buffer(alpha.texels, "the cut-out textures");
}

std::string RasterScene::defines() const {
    return has_alpha_ ? "#define PRT_ALPHA\n" : "";
}

void RasterScene::bind() const {
    bind_storage(PRT_BINDING_CORNERS, corners_);
    bind_storage(PRT_BINDING_ALPHA_TRIANGLES, alpha_triangles_);
    bind_storage(PRT_BINDING_ALPHA_MATERIALS, alpha_materials_);
    bind_storage(PRT_BINDING_ALPHA_TEXELS, alpha_texels_);
}

} // namespace prt
