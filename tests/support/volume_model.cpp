// Builds a file with a volume.

#include "support/volume_model.h"

#include "bake/gltf/encode_glb.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"

#include <string>

namespace prt::test {

GlbFile with_volume(const GlbFile& scene, const CompressedVolume& volume) {
    const std::string text = scene.bytes();
    GltfDocument document = parse_gltf(std::as_bytes(std::span(text)), "scene.glb");
    write_volume(document, extract_scene(document), volume);
    return glb_of(encode_glb(document));
}

} // namespace prt::test
