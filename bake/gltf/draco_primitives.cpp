// Decompresses primitives with KHR_draco_mesh_compression when a file is read.
#include "bake/gltf/draco_primitives.h"

#include "bake/gltf/draco_mesh.h"
#include "prt/core/error.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace prt {
namespace {

constexpr int kIndices = -1; ///< used instead of an attribute's id

/// One compressed primitive, in the JSON and in tinygltf's model.
struct Position {
    Json& json;
    GltfPrimitive& model;
    Json attributes; ///< names and ids in the compressed mesh
    std::string name;
};

/// Returns whether all compressed data also exists uncompressed.
bool has_plain_data(const GltfContents& contents, const Json& primitive) {
    const auto is_plain = [&](const Json& reference) {
        return contents.model.accessors.at(reference.get<std::size_t>()).bufferView >= 0;
    };
    const Json& compressed = extension_of(primitive, kDracoExtension)->at("attributes");
    return primitive.contains("indices") && is_plain(primitive["indices"]) &&
           std::all_of(compressed.items().begin(), compressed.items().end(),
                       [&](const auto& item) { return is_plain(primitive.at("attributes").at(item.key())); });
}

class Decompressor {
public:
    explicit Decompressor(GltfContents& contents) : contents_(contents) {}

    /// Decodes `view` once for all `positions` that use it.
    void decompress(std::size_t view, std::vector<Position>& positions) {
        std::string name = positions.front().name;
        try {
            const auto mesh = decode_draco(buffer_view_bytes(contents_.model, static_cast<int>(view)));
            const bool small = mesh->num_points() <= 65535; // the last index means a restart
            index_type_ = small ? kUnsignedShort : kUnsignedInt;
            set_view(view, draco_indices(*mesh, index_type_), 0);
            for (Position& position : positions) {
                name = position.name;
                decompress(view, *mesh, position);
            }
        } catch (const std::exception& error) { // errors of prtkit and of the JSON library, and bad_alloc
            throw Error(name + ": " + error.what());
        }
    }

private:
    void decompress(std::size_t view, const draco::Mesh& mesh, Position& position) {
        Json indices = position.json.value("indices", Json());
        set_accessor(indices, {view, kIndices}, [&](Json& accessor) {
            accessor["bufferView"] = view;
            accessor["componentType"] = index_type_;
            accessor["count"] = 3 * std::size_t{mesh.num_faces()};
            accessor["type"] = "SCALAR";
            accessor.erase("min");
            accessor.erase("max");
        });
        position.json["indices"] = indices;
        position.model.indices = indices.get<int>();
        position.json.erase("mode"); // strips are decoded as triangles
        position.model.mode = kTriangles;
        for (const auto& item : position.attributes.items()) {
            Json& reference = position.json.at("attributes").at(item.key());
            const int id = item.value().get<int>();
            set_accessor(reference, {view, id}, [&](Json& accessor) { fill(accessor, mesh, id); });
            position.model.attributes[item.key()] = reference.get<int>();
        }
        check_counts(mesh.num_points(), position);
    }

    void fill(Json& accessor, const draco::Mesh& mesh, int id) {
        const DracoAttribute data = draco_attribute(mesh, id, accessor.at("componentType").get<int>(),
                                                    component_count(accessor.at("type")));
        accessor["bufferView"] = contents_.json["bufferViews"].size();
        accessor["count"] = mesh.num_points();
        if (accessor.contains("min") || accessor.contains("max")) {
            accessor["min"] = data.low;
            accessor["max"] = data.high;
        }
        contents_.json["bufferViews"].push_back(Json::object());
        contents_.model.bufferViews.emplace_back();
        set_view(contents_.json["bufferViews"].size() - 1, data.bytes, data.stride);
    }

    /// Fills the accessor of `reference` from `source` by `change`. Creates a new accessor if it is missing,
    /// or if it already holds other decoded data.
    template <class Change>
    void set_accessor(Json& reference, std::pair<std::size_t, int> source, const Change& change) {
        Json& accessors = member(contents_.json, "accessors", Json::value_t::array);
        const bool given = !reference.is_null();
        const Json before = given ? accessors.at(reference.get<std::size_t>()) : Json::object();
        if (!given || !filled_.try_emplace(reference.get<std::size_t>(), source).second) {
            if (given && filled_.at(reference.get<std::size_t>()) == source)
                return;
            reference = accessors.size();
            filled_.emplace(accessors.size(), source);
            accessors.push_back(before);
            contents_.model.accessors.emplace_back();
        }
        const auto index = reference.get<std::size_t>();
        Json& accessor = accessors[index];
        change(accessor);
        accessor.erase("byteOffset");
        accessor.erase("sparse");
        GltfAccessor& model = contents_.model.accessors.at(index);
        model.bufferView = accessor["bufferView"].get<int>();
        model.byteOffset = 0;
        model.componentType = accessor["componentType"].get<int>();
        model.normalized = accessor.value("normalized", false);
        model.count = accessor["count"].get<std::size_t>();
        model.components = component_count(accessor["type"].get<std::string>());
        model.sparse.reset();
    }

    /// Puts `bytes` into a new buffer, and makes `view` cover all of it.
    void set_view(std::size_t view, std::vector<std::byte> bytes, std::size_t stride) {
        bytes.resize(std::max<std::size_t>(bytes.size(), 4)); // glTF does not allow empty views
        total_ += static_cast<double>(bytes.size());
        check_allowed(2 * total_, contents_.file_bytes, "the decompressed Draco data"); // also while joined
        Json& json = contents_.json["bufferViews"].at(view);
        json["buffer"] = contents_.model.buffers.size();
        json["byteOffset"] = 0;
        json["byteLength"] = bytes.size();
        json["target"] = stride > 0 ? kArrayBuffer : kElementArrayBuffer;
        if (stride > 0)
            json["byteStride"] = stride;
        else
            json.erase("byteStride");
        GltfBufferView& model = contents_.model.bufferViews.at(view);
        model.buffer = static_cast<int>(contents_.model.buffers.size());
        model.byteOffset = 0;
        model.byteLength = bytes.size();
        model.byteStride = stride;
        const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
        contents_.model.buffers.emplace_back().data.assign(begin, begin + bytes.size());
    }

    /// Throws if uncompressed attributes, which refer to the original vertices, have another number of
    /// elements.
    void check_counts(std::size_t points, const Position& position) const {
        const auto check = [&](const Json& attributes) {
            for (const auto& item : attributes.items()) {
                const std::size_t count = contents_.model.accessors.at(item.value().get<std::size_t>()).count;
                if (count != points)
                    throw Error("its Draco data has " + std::to_string(points) +
                                " vertices, but its uncompressed attribute " + item.key() + " has " +
                                std::to_string(count));
            }
        };
        check(position.json.at("attributes"));
        for (const Json& target : position.json.value("targets", Json::array()))
            check(target);
    }

    GltfContents& contents_;
    std::map<std::size_t, std::pair<std::size_t, int>> filled_; ///< accessor: compressed view, attribute
    int index_type_ = kUnsignedInt;
    double total_ = 0; ///< bytes created
};

} // namespace

bool has_draco_primitives(const Json& json) {
    bool found = false;
    for_each_primitive(
        json, [&](const Json& primitive) { found = found || extension_of(primitive, kDracoExtension); });
    return found;
}

Json without_draco_indices(Json json) {
    for_each_primitive(json, [&](Json& primitive) {
        if (extension_of(primitive, kDracoExtension) && primitive.contains("indices") &&
            !json.at("accessors").at(primitive["indices"].get<std::size_t>()).contains("bufferView"))
            primitive.erase("indices");
    });
    return json;
}

void decompress_primitives(GltfContents& contents) {
    const Json required = contents.json.value("extensionsRequired", Json::array());
    const bool is_required = std::find(required.begin(), required.end(), kDracoExtension) != required.end();
    std::map<std::size_t, std::vector<Position>> positions; // by compressed view
    for (std::size_t m = 0; m < contents.model.meshes.size(); ++m)
        for (std::size_t p = 0; p < contents.model.meshes[m].primitives.size(); ++p) {
            Json& primitive = contents.json.at("meshes").at(m).at("primitives").at(p);
            const Json* extension = extension_of(primitive, kDracoExtension);
            if (!extension)
                continue;
            if (is_required || !has_plain_data(contents, primitive))
                positions[extension->at("bufferView").get<std::size_t>()].push_back(
                    {primitive, contents.model.meshes[m].primitives[p], extension->at("attributes"),
                     "mesh " + std::to_string(m) + " primitive " + std::to_string(p)});
            erase_extension(primitive, kDracoExtension);
        }
    Decompressor decompressor(contents);
    for (auto& [view, users] : positions)
        decompressor.decompress(view, users);
    drop_extension(contents.json, kDracoExtension);
}

} // namespace prt
