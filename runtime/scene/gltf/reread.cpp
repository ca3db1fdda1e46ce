#include "gltf/reread.h"

#include "gltf/contents.h"
#include "prt/encode_glb.h"

namespace prt {

GltfDocument reread(const GltfDocument& document) {
    // What could be read of images is inside by now.
    GltfDocument again = parse_gltf(encode_glb(document), document.contents().path,
                                    {.scene_limit = document.contents().scene_limit});
    again.contents().notices = document.contents().notices;
    return again;
}

} // namespace prt
