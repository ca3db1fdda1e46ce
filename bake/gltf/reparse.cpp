// Writes and parses a document.
#include "bake/gltf/reparse.h"

#include "bake/gltf/contents.h"
#include "bake/gltf/encode_glb.h"

namespace prt {

GltfDocument reparse(const GltfDocument& document, Instancing instancing) {
    // All readable images are embedded at this point.
    GltfDocument again =
        parse_gltf(encode_glb(document), document.contents().path,
                   {.instancing = instancing, .scene_limit = document.contents().scene_limit});
    again.contents().notices = document.contents().notices;
    return again;
}

} // namespace prt
