// Adds smooth normals to primitives without normals.

#include "bake/gltf/smooth_primitives.h"

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/smooth_normals.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"
#include "runtime/load/triangles.h"

#include <sstream>

namespace prt {

bool smooth_primitives(GltfContents& contents, double degrees) {
    std::size_t primitives = 0, before = 0, after = 0;
    for (std::size_t m = 0; m < contents.model.meshes.size(); ++m)
        for (std::size_t p = 0; p < contents.model.meshes[m].primitives.size(); ++p) {
            const GltfPrimitive& primitive = contents.model.meshes[m].primitives[p];
            const auto position = primitive.attributes.find("POSITION");
            if (!is_triangle_mode(primitive.mode) || primitive.attributes.contains("NORMAL") ||
                position == primitive.attributes.end())
                continue;
            const std::vector<float> values = read_floats(contents.model, position->second, 3);
            std::vector<glm::vec3> positions;
            for (std::size_t i = 0; i < values.size(); i += 3)
                positions.emplace_back(values[i], values[i + 1], values[i + 2]);
            const SmoothVertices smooth = smooth_vertices(
                positions, read_triangles(contents.model, primitive, positions.size()), degrees);
            replace_vertices(contents, contents.json["meshes"][m]["primitives"][p], smooth.source,
                             smooth.normals, smooth.triangles);
            ++primitives;
            before += positions.size();
            after += smooth.source.size();
        }
    if (primitives == 0)
        return false;
    std::ostringstream notice;
    notice << counted(primitives, "primitive has", "primitives have")
           << " no normals; normals are created, smooth across edges of at most " << degrees
           << " degrees: " << before << " vertices become " << after;
    contents.notices.push_back(notice.str());
    return true;
}

} // namespace prt
