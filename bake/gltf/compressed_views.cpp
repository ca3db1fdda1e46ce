// Compresses buffer views with EXT_meshopt_compression.
#include "bake/gltf/compressed_views.h"

#include "prt/core/error.h"
#include "runtime/load/accessor.h"
#include "runtime/load/extensions.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

namespace prt {
namespace {

constexpr const char* kFallback = "data:application/octet-stream;base64,AAAA";

/// Contents of a view, as far as the extension can compress them.
struct ViewUse {
    bool vertices = false, indices = false, triangles = true, other = false;
    std::size_t element = 0; ///< bytes
};

std::vector<ViewUse> view_uses(const Json& json) {
    std::vector<ViewUse> uses(json.value("bufferViews", Json::array()).size());
    std::vector<ViewUse> by_accessor(json.value("accessors", Json::array()).size());
    const auto vertices = [&](const Json& attributes) {
        for (const auto& item : attributes.items())
            by_accessor.at(item.value().get<std::size_t>()).vertices = true;
    };
    for_each_primitive(json, [&](const Json& primitive) {
        vertices(primitive.at("attributes"));
        if (primitive.contains("targets"))
            for (const Json& target : primitive["targets"])
                vertices(target);
        if (primitive.contains("indices")) {
            ViewUse& use = by_accessor.at(primitive["indices"].get<std::size_t>());
            use.indices = true;
            use.triangles = use.triangles && primitive.value("mode", 4) == 4;
        }
    });
    for (std::size_t a = 0; a < by_accessor.size(); ++a) {
        const Json& accessor = json["accessors"][a];
        if (accessor.contains("sparse"))
            for (const char* part : {"indices", "values"})
                uses.at(accessor["sparse"][part].at("bufferView").get<std::size_t>()).other = true;
        if (!accessor.contains("bufferView"))
            continue;
        ViewUse& use = uses.at(accessor["bufferView"].get<std::size_t>());
        const std::size_t element = component_bytes(accessor.at("componentType").get<int>()) *
                                    static_cast<std::size_t>(component_count(accessor.at("type")));
        use.other = use.other || (!by_accessor[a].vertices && !by_accessor[a].indices) ||
                    (use.element != 0 && use.element != element &&
                     !json["bufferViews"][accessor["bufferView"].get<std::size_t>()].contains("byteStride"));
        use.vertices = use.vertices || by_accessor[a].vertices;
        use.indices = use.indices || by_accessor[a].indices;
        use.triangles = use.triangles && by_accessor[a].triangles;
        use.element = element;
    }
    return uses;
}

/// Compressed bytes and the extension object that describes them.
struct CompressedView {
    std::vector<unsigned char> bytes;
    Json extension;
};

std::optional<CompressedView> compressed(const Json& view, const ViewUse& use,
                                         std::span<const std::byte> bytes) {
    if (use.other || use.vertices == use.indices)
        return std::nullopt;
    const std::size_t stride = use.vertices ? view.value("byteStride", use.element) : use.element;
    if (stride == 0 || bytes.size() % stride != 0 || bytes.empty())
        return std::nullopt;
    const std::size_t count = bytes.size() / stride;
    CompressedView result;
    std::string mode = "ATTRIBUTES";
    if (use.vertices) {
        if (stride % 4 != 0 || stride > 256)
            return std::nullopt;
        result.bytes.resize(meshopt_encodeVertexBufferBound(count, stride));
        meshopt_encodeVertexVersion(0); // required by the extension
        result.bytes.resize(meshopt_encodeVertexBuffer(result.bytes.data(), result.bytes.size(), bytes.data(),
                                                       count, stride));
    } else {
        if (stride != 2 && stride != 4)
            return std::nullopt;
        std::vector<unsigned> indices(count);
        unsigned most = 0;
        for (std::size_t i = 0; i < count; ++i) {
            std::memcpy(&indices[i], &bytes[i * stride], stride); // little-endian, like glTF
            most = std::max(most, indices[i]);
        }
        const bool triangles = use.triangles && count % 3 == 0;
        mode = triangles ? "TRIANGLES" : "INDICES";
        meshopt_encodeIndexVersion(1); // required by the extension
        result.bytes.resize(triangles ? meshopt_encodeIndexBufferBound(count, most + std::size_t{1})
                                      : meshopt_encodeIndexSequenceBound(count, most + std::size_t{1}));
        result.bytes.resize(triangles ? meshopt_encodeIndexBuffer(result.bytes.data(), result.bytes.size(),
                                                                  indices.data(), count)
                                      : meshopt_encodeIndexSequence(result.bytes.data(), result.bytes.size(),
                                                                    indices.data(), count));
    }
    if (result.bytes.size() >= bytes.size())
        return std::nullopt;
    result.extension = {
        {"buffer", 0}, {"byteLength", result.bytes.size()}, {"byteStride", stride}, {"count", count}};
    result.extension["mode"] = mode;
    return result;
}

std::size_t append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
    to.resize((to.size() + 7) / 8 * 8);
    const std::size_t begin = to.size();
    to.insert(to.end(), bytes.begin(), bytes.end());
    return begin;
}

} // namespace

Json without_meshopt(Json json) {
    for (Json& view : json["bufferViews"])
        if (const Json* extension = extension_of(view, kMeshoptExtension)) {
            const Json source = *extension;
            view = {{"buffer", source.at("buffer")},
                    {"byteOffset", source.value("byteOffset", std::size_t{0})},
                    {"byteLength", source.at("byteLength")}};
        }
    if (json.contains("buffers"))
        for (std::size_t b = 0; b < json["buffers"].size(); ++b) {
            Json& buffer = json["buffers"][b];
            if (const Json* extension = extension_of(buffer, kMeshoptExtension);
                extension && extension->value("fallback", false))
                buffer = {{"byteLength", 3}, {"uri", kFallback}};
        }
    erase_name(json, "extensionsRequired", kMeshoptExtension);
    return json;
}

CompressedGlb compress_views(const GltfContents& contents) {
    const auto uncompressed = [&] {
        return CompressedGlb{contents.json, {contents.binary().begin(), contents.binary().end()}};
    };
    CompressedGlb result{contents.json, {}};
    if (!contents.json.contains("bufferViews"))
        return uncompressed();
    const std::vector<ViewUse> uses = view_uses(contents.json);
    std::size_t fallback = 0;
    for (std::size_t v = 0; v < uses.size(); ++v) {
        Json& view = result.json["bufferViews"][v];
        const auto bytes = contents.binary().subspan(view.value("byteOffset", std::size_t{0}),
                                                     view.at("byteLength").get<std::size_t>());
        auto packed = compressed(view, uses[v], bytes);
        if (!packed) {
            view["byteOffset"] = append(result.binary, bytes);
            continue;
        }
        packed->extension["byteOffset"] = append(result.binary, std::as_bytes(std::span(packed->bytes)));
        view["buffer"] = 1;
        view["byteOffset"] = fallback;
        extensions_of(view)[kMeshoptExtension] = packed->extension;
        fallback += (bytes.size() + 7) / 8 * 8;
    }
    if (fallback == 0)
        return uncompressed();
    Json stand_in = {{"byteLength", fallback}};
    extensions_of(stand_in)[kMeshoptExtension] = {{"fallback", true}};
    result.json["buffers"] = Json::array({Json{{"byteLength", result.binary.size()}}, stand_in});
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        member(result.json, list, Json::value_t::array).push_back(kMeshoptExtension);
    return result;
}

} // namespace prt
