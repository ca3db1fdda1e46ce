// Checks that views are inside buffers, accessors inside views, and attributes have equal length.
#include "runtime/load/check_data.h"

#include "prt/core/error.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"

#include <map>
#include <string>

namespace prt {
namespace {

void check_lengths(const GltfModel& model, const GltfAttributes& attributes, std::size_t vertices) {
    for (const auto& [name, accessor] : attributes) {
        const std::size_t count = get_accessor(model, accessor).count;
        if (count != vertices)
            throw Error(name + " has " + std::to_string(count) + " elements, but the primitive has " +
                        std::to_string(vertices) + " vertices");
    }
}

void check_primitive(const GltfModel& model, const GltfPrimitive& primitive) {
    if (primitive.indices >= 0)
        get_accessor(model, primitive.indices);
    for (const auto& [name, accessor] : primitive.attributes)
        get_accessor(model, accessor);
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) // nothing that is drawn or gathered
        return;
    const std::size_t vertices = get_accessor(model, position->second).count;
    check_lengths(model, primitive.attributes, vertices);
    for (const GltfAttributes& target : primitive.targets)
        check_lengths(model, target, vertices);
}

} // namespace

void check_data(const GltfData& data) {
    const GltfModel& model = data.model;
    for (std::size_t v = 0; v < model.bufferViews.size(); ++v)
        buffer_view_bytes(model, static_cast<int>(v));
    for (std::size_t a = 0; a < model.accessors.size(); ++a) {
        const std::size_t bytes = check_accessor(model, static_cast<int>(a));
        if (model.accessors[a].bufferView < 0) // implicit zeros without data
            check_allowed(static_cast<double>(model.accessors[a].count) * static_cast<double>(bytes),
                          data.file_bytes, "accessor " + std::to_string(a) + ", which has no buffer view,");
    }
    for (std::size_t m = 0; m < model.meshes.size(); ++m)
        for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p)
            try {
                check_primitive(model, model.meshes[m].primitives[p]);
            } catch (const Error& error) {
                throw Error("mesh " + std::to_string(m) + " primitive " + std::to_string(p) + ": " +
                            error.what());
            }
}

} // namespace prt
