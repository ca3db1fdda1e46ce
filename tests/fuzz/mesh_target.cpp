// An OBJ or PLY file is read as a scene: the first byte chooses.
#include "target.h"

#include "prt/gltf/gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace prt;
    if (size == 0)
        return 0;
    const char* name = data[0] % 2 == 0 ? "mesh.ply" : "mesh.obj";
    return fuzz::take([&] {
        const Scene scene = extract_scene(parse_gltf(fuzz::bytes(data + 1, size - 1), name));
        for (const VertexArray& vertices : scene.vertex_arrays)
            for (const glm::vec3& p : vertices.positions)
                fuzz::expect_finite(std::span<const float>(&p.x, 3), "a position");
    });
}
