// Extracts the scene of a document: geometry, materials with textures, images and lights.
#include "prt/gltf/gltf.h"

#include "bake/gltf/contents.h"
#include "bake/gltf/extraction.h"
#include "bake/gltf/lights.h"
#include "bake/gltf/material.h"
#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <string>
#include <utility>

namespace prt {
namespace {

std::vector<EncodedImage> images_of(const GltfContents& contents) {
    std::vector<EncodedImage> images;
    for (std::size_t i = 0; i < contents.images.size(); ++i) {
        const tinygltf::Image& image = contents.parsed.images[i];
        const std::string name = !image.uri.empty() ? image.uri : image.name;
        images.push_back({"image " + std::to_string(i) + (name.empty() ? "" : " '" + printable(name) + "'"),
                          contents.images[i], contents.image_troubles[i]});
    }
    return images;
}

/// Adds images, lights and all properties of materials.
Geometry complete(const GltfContents& contents, Geometry geometry, UnitRange& range) {
    Scene& scene = geometry.scene;
    scene.images = images_of(contents);
    read_materials(contents.parsed, scene, range);
    std::vector<std::string> notices = contents.notices;
    scene.lights = read_lights(contents, geometry.nodes.finest, scene.origin, notices);
    notices.insert(notices.end(), scene.notices.begin(), scene.notices.end());
    if (!range.notice().empty())
        notices.push_back(range.notice());
    for (std::string& notice : unread_material_notices(contents.parsed, scene))
        notices.push_back(std::move(notice));
    scene.notices = std::move(notices);
    return geometry;
}

} // namespace

Geometry extract(const GltfContents& contents, Keep keep) {
    UnitRange range;
    Geometry geometry = extract_geometry(contents, range, keep);
    return complete(contents, std::move(geometry), range);
}

Geometry extract_with_levels(const GltfContents& contents, Keep keep) {
    UnitRange range;
    Geometry geometry = extract_geometry_with_levels(contents, range, keep);
    return complete(contents, std::move(geometry), range);
}

Scene extract_scene(const GltfDocument& document) {
    try {
        return extract(document.contents(), Keep::scene).scene;
    } catch (const std::exception& error) { // errors of prtkit and of the standard library
        throw Error(document.contents().path.string() + ": " + in_plain_words(error));
    }
}

} // namespace prt
