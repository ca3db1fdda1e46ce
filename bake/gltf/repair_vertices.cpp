// Replaces unusable normals and texture coordinates in the document.
#include "bake/gltf/repair_vertices.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/triangle_normal.h"
#include "runtime/load/triangles.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace prt {
namespace {

bool is_floats(const GltfModel& model, int accessor, int components) {
    const GltfAccessor& a = get_accessor(model, accessor);
    return a.componentType == kFloat && a.components == components && a.count > 0;
}

/// Values of an accessor, some of which are unusable.
struct Damaged {
    std::vector<float> values;
    std::vector<std::size_t> elements; ///< indices of unusable elements
};

/// Returns the values of an accessor and its unusable elements; no value if all elements are usable.
template <class IsUsable>
std::optional<Damaged> find_damaged(const GltfModel& model, int accessor, std::size_t width,
                                    IsUsable&& is_usable) {
    Damaged damaged{read_floats(model, accessor, static_cast<int>(width)), {}};
    for (std::size_t i = 0; i * width < damaged.values.size(); ++i)
        if (!is_usable(&damaged.values[i * width]))
            damaged.elements.push_back(i);
    if (damaged.elements.empty())
        return std::nullopt;
    return damaged;
}

/// Stores `values` in a new buffer view for `accessor`, which has no buffer view or is sparse.
void give_own_values(GltfContents& contents, std::size_t accessor, std::span<const float> values) {
    const std::size_t view = contents.add_buffer_view(std::as_bytes(values));
    GltfAccessor& model = contents.model.accessors[accessor];
    model.bufferView = static_cast<int>(view);
    model.byteOffset = 0;
    model.sparse.reset();
    Json& of_file = contents.json["accessors"][accessor];
    of_file["bufferView"] = view;
    for (const char* key : {"sparse", "byteOffset"})
        of_file.erase(key);
}

/// Writes the elements of `accessor` that were damaged and have been repaired into the document.
void write_back(GltfContents& contents, int accessor, std::size_t width, const Damaged& damaged) {
    const auto index = static_cast<std::size_t>(accessor);
    const GltfAccessor& model = contents.model.accessors[index];
    for (const char* key : {"min", "max"}) // they belong to the replaced values
        contents.json["accessors"][index].erase(key);
    if (model.bufferView < 0 || model.sparse) {
        give_own_values(contents, index, damaged.values);
        return;
    }
    const GltfBufferView& view = contents.model.bufferViews[static_cast<std::size_t>(model.bufferView)];
    const std::size_t size = width * sizeof(float), stride = view.byteStride > 0 ? view.byteStride : size;
    for (const std::size_t i : damaged.elements)
        std::memcpy(&contents.binary()[view.byteOffset + model.byteOffset + i * stride],
                    &damaged.values[i * width], size);
}

/// Sets texture coordinates that are not finite to zero. Returns their number.
std::size_t repair_texcoords(GltfContents& contents, const GltfPrimitive& primitive) {
    std::size_t replaced = 0;
    for (const auto& [name, accessor] : primitive.attributes) {
        if (!name.starts_with("TEXCOORD_") || !is_floats(contents.model, accessor, 2))
            continue;
        std::optional<Damaged> damaged = find_damaged(contents.model, accessor, 2, [](const float* uv) {
            return std::isfinite(uv[0]) && std::isfinite(uv[1]);
        });
        if (!damaged)
            continue;
        for (const std::size_t i : damaged->elements)
            std::fill_n(&damaged->values[2 * i], 2, 0.0f);
        write_back(contents, accessor, 2, *damaged);
        replaced += damaged->elements.size();
    }
    return replaced;
}

/// Replaces unusable normals of accessors by the normals of the triangles around their vertices.
class NormalRepair {
public:
    explicit NormalRepair(GltfContents& contents) : contents_(contents) {}

    void add(const GltfPrimitive& primitive) {
        const int normal = attribute_of(primitive, "NORMAL"), position = attribute_of(primitive, "POSITION");
        if (normal < 0 || position < 0 || !is_triangle_mode(primitive.mode) ||
            !is_floats(contents_.model, normal, 3))
            return;
        const auto [found, is_new] = normals_.try_emplace(normal);
        if (is_new)
            found->second.damaged = find_damaged(contents_.model, normal, 3, [](const float* n) {
                return unit_or_zero({n[0], n[1], n[2]}) != glm::vec3(0);
            });
        if (found->second.damaged)
            add_triangles(primitive, position, found->second);
    }

    /// Writes the new normals. Returns the number of replaced normals.
    std::size_t finish() {
        std::size_t replaced = 0;
        for (auto& [accessor, normals] : normals_) {
            if (!normals.damaged)
                continue;
            for (const std::size_t i : normals.damaged->elements) {
                const glm::vec3 normal = unit_or_zero(normals.sums[i]);
                std::memcpy(&normals.damaged->values[3 * i], &normal, sizeof normal);
                replaced += normal != glm::vec3(0);
            }
            write_back(contents_, accessor, 3, *normals.damaged);
        }
        return replaced;
    }

private:
    struct Normals {
        std::optional<Damaged> damaged;
        /// [vertices] sum of the normals of the triangles at each vertex, weighted by area.
        std::vector<glm::dvec3> sums;
    };

    void add_triangles(const GltfPrimitive& primitive, int position, Normals& normals) {
        // Work per element, counted in bytes: limits files that use one accessor in many primitives.
        constexpr double kElement = 64;
        const std::vector<float> p = read_floats(contents_.model, position, 3);
        const std::size_t vertices = p.size() / 3;
        const std::vector<glm::uvec3> triangles = read_triangles(contents_.model, primitive, vertices);
        bytes_ += kElement * static_cast<double>(vertices + triangles.size());
        check_allowed(bytes_, contents_.file_bytes, "the replacement of its unusable normals");
        normals.sums.resize(std::max(normals.sums.size(), normals.damaged->values.size() / 3));
        const auto at = [&](std::uint32_t i) { return glm::dvec3(p[3 * i], p[3 * i + 1], p[3 * i + 2]); };
        for (const glm::uvec3& t : triangles)
            for (int corner = 0; corner < 3; ++corner)
                if (t[corner] < normals.sums.size())
                    normals.sums[t[corner]] += area_normal(at(t.x), at(t.y), at(t.z));
    }

    GltfContents& contents_;
    std::map<int, Normals> normals_;
    double bytes_ = 0;
};

} // namespace

void repair_vertices(GltfContents& contents) {
    NormalRepair normals(contents);
    std::size_t texcoords = 0;
    for (std::size_t m = 0; m < contents.model.meshes.size(); ++m)
        for (std::size_t p = 0; p < contents.model.meshes[m].primitives.size(); ++p)
            try {
                texcoords += repair_texcoords(contents, contents.model.meshes[m].primitives[p]);
                normals.add(contents.model.meshes[m].primitives[p]);
            } catch (const Error& error) {
                throw Error("mesh " + std::to_string(m) + " primitive " + std::to_string(p) + ": " +
                            error.what());
            }
    if (const std::size_t replaced = normals.finish(); replaced > 0)
        contents.notices.push_back(counted(replaced, "normal is", "normals are") +
                                   " zero or not finite; the normal of the adjacent triangles is used, also "
                                   "in the output");
    if (texcoords > 0)
        contents.notices.push_back(counted(texcoords, "texture coordinate is", "texture coordinates are") +
                                   " not finite and set to 0, also in the output");
}

} // namespace prt
