// Rewrites primitives with vertices split for new texture coordinates.

#include "bake/gltf/vertex_splits.h"

#include "bake/gltf/edit_meshes.h"
#include "bake/gltf/gathered_accessor.h"

#include <algorithm>
#include <set>
#include <utility>

namespace prt {
namespace {

class SplitWriter {
public:
    explicit SplitWriter(GltfContents& contents) : contents_(contents) {}

    void write(Json& primitive, const VertexSplit& split, int set, bool mirrored) {
        gather(primitive["attributes"], split.source);
        if (primitive.contains("targets"))
            for (Json& target : primitive["targets"])
                gather(target, split.source);
        const std::size_t view =
            contents_.add_buffer_view(std::as_bytes(std::span(split.uv)), sizeof(glm::vec2), true);
        const std::size_t accessor = contents_.add_accessor(
            {{"bufferView", view}, {"componentType", kFloat}, {"count", split.uv.size()}, {"type", "VEC2"}});
        primitive["attributes"]["TEXCOORD_" + std::to_string(set)] = accessor;
        for (int s = 0; s < set; ++s)
            if (const std::string name = "TEXCOORD_" + std::to_string(s);
                !primitive["attributes"].contains(name))
                primitive["attributes"][name] = add_zeros(split.uv.size());
        replace_triangles(contents_, primitive, split.triangles, mirrored, replaced_);
    }
    void finish() { contents_.remove_unused(std::move(replaced_)); }

private:
    /// Adds an accessor of zeros for missing coordinates; it takes no bytes.
    std::size_t add_zeros(std::size_t count) {
        return contents_.add_accessor({{"componentType", kFloat}, {"count", count}, {"type", "VEC2"}});
    }

    void gather(Json& attributes, const std::vector<std::uint32_t>& source) {
        for (auto it = attributes.begin(); it != attributes.end(); ++it) {
            replaced_.insert(it->get<std::size_t>());
            *it = add_gathered_accessor(contents_, *it, source);
        }
    }

    GltfContents& contents_;
    std::set<std::size_t> replaced_; ///< accessors
};

} // namespace

int free_texcoord(const Scene& scene) {
    std::size_t sets = 0;
    for (const VertexArray& vertices : scene.vertex_arrays)
        sets = std::max(sets, vertices.texcoords.size());
    return static_cast<int>(sets);
}

GltfDocument with_texcoords(GltfDocument document, const Scene& scene, std::span<const VertexSplit> splits,
                            int set) {
    return edit_meshes(std::move(document), scene, [&](GltfContents& contents) {
        SplitWriter writer(contents);
        for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
            if (splits[p].source.empty())
                continue; // has no texels
            const Primitive& primitive = scene.primitives[p];
            const auto mesh = contents.json["nodes"][static_cast<std::size_t>(primitive.node)]["mesh"];
            writer.write(contents.json["meshes"][mesh.get<std::size_t>()]["primitives"]
                                      [static_cast<std::size_t>(primitive.primitive)],
                         splits[p], set, primitive.mirrored);
        }
        writer.finish();
    });
}

} // namespace prt
