// Decompresses views with EXT_meshopt_compression when a file is read, and compresses them when it is
// written.
#include "runtime/scene/gltf/meshopt_views.h"

#include "prt/core/error.h"
#include "runtime/scene/gltf/accessor.h"
#include "runtime/scene/gltf/allowance.h"
#include "runtime/support/counted.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

namespace prt {
namespace {

constexpr const char* kFallback = "data:application/octet-stream;base64,AAAA";

void erase_extension(Json& object) {
    object["extensions"].erase(kMeshoptExtension);
    if (object["extensions"].empty())
        object.erase("extensions");
}

void erase_name(Json& json, const char* list) {
    if (!json.contains(list))
        return;
    Json kept = Json::array();
    for (const Json& name : json[list])
        if (name != kMeshoptExtension)
            kept.push_back(name);
    if (kept.empty())
        json.erase(list);
    else
        json[list] = kept;
}

/// Parameters of a compressed view.
struct MeshoptCode {
    std::size_t count, stride;
    std::string mode, filter;
};

MeshoptCode read_code(const Json& extension) {
    return {extension.at("count").get<std::size_t>(), extension.at("byteStride").get<std::size_t>(),
            extension.at("mode"), extension.value("filter", "NONE")};
}

std::vector<unsigned char> decompressed(const MeshoptCode& code, std::span<const unsigned char> source) {
    const auto& [count, stride, mode, filter] = code;
    const bool attributes = mode == "ATTRIBUTES";
    if (attributes ? stride == 0 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
        throw Error("has an invalid stride of " + counted(stride, "byte"));
    if (!attributes && mode != "TRIANGLES" && mode != "INDICES")
        throw Error("has the unknown mode '" + mode + "'");
    if (mode == "TRIANGLES" && count % 3 != 0)
        throw Error("contains triangles, but its number of indices, " + std::to_string(count) +
                    ", is not a multiple of 3");
    // Every 16 elements of a byte each take at least one or two bits: a much larger count is invalid.
    if (count > source.size() * 1024)
        throw Error("claims " + std::to_string(count) + " elements, but has only " +
                    counted(source.size(), "byte"));
    // The upper half of the first byte identifies the codec, the lower half its version.
    constexpr unsigned char kAttributes = 0xa0;
    if (attributes && !source.empty() && (source[0] & 0xf0) == kAttributes && source[0] != kAttributes)
        throw Error("uses version " + std::to_string(source[0] & 0x0f) +
                    " of the attribute codec, but only version 0 is supported; write the file with "
                    "EXT_meshopt_compression or without compression");
    std::vector<unsigned char> result(count * stride);
    const int status =
        attributes ? meshopt_decodeVertexBuffer(result.data(), count, stride, source.data(), source.size())
        : mode == "TRIANGLES"
            ? meshopt_decodeIndexBuffer(result.data(), count, stride, source.data(), source.size())
            : meshopt_decodeIndexSequence(result.data(), count, stride, source.data(), source.size());
    if (status != 0)
        throw Error("is damaged");
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(result.data(), count, stride);
    else if (filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(result.data(), count, stride);
    else if (filter == "EXPONENTIAL" && stride % 4 == 0)
        meshopt_decodeFilterExp(result.data(), count, stride);
    else if (filter != "NONE")
        throw Error("has the filter '" + filter + "', which does not match its mode or stride");
    return result;
}

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
        const std::size_t element =
            component_bytes(accessor.at("componentType").get<int>()) *
            static_cast<std::size_t>(component_count(tinygltf_type(accessor.at("type"))));
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

bool use_ext_meshopt(Json& json) {
    constexpr const char* kKhronos = "KHR_meshopt_compression";
    bool found = false;
    for (const char* list : {"bufferViews", "buffers"})
        if (json.contains(list) && json[list].is_array())
            for (Json& owner : json[list])
                if (const Json* extension = owner.is_object() ? extension_of(owner, kKhronos) : nullptr) {
                    Json renamed = *extension;
                    owner["extensions"].erase(kKhronos);
                    if (!owner["extensions"].contains(
                            kMeshoptExtension)) // otherwise the existing one needs no newer codec
                        owner["extensions"][kMeshoptExtension] = std::move(renamed);
                    found = true;
                }
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        if (json.contains(list) && json[list].is_array())
            for (Json& name : json[list])
                if (name == kKhronos) {
                    name = kMeshoptExtension;
                    found = true;
                }
    return found;
}

bool has_meshopt_views(const Json& json) {
    const auto views = json.find("bufferViews");
    return views != json.end() && std::any_of(views->begin(), views->end(), [](const Json& view) {
               return extension_of(view, kMeshoptExtension) != nullptr;
           });
}

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
    erase_name(json, "extensionsRequired");
    return json;
}

void decompress_views(GltfContents& contents) {
    Json& views = contents.json["bufferViews"];
    double total = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
        const Json* extension = extension_of(views[v], kMeshoptExtension);
        if (!extension)
            continue;
        try {
            const auto source = buffer_view_bytes(contents.model, static_cast<int>(v));
            const MeshoptCode code = read_code(*extension);
            total += static_cast<double>(code.count) * static_cast<double>(code.stride);
            check_allowed(2 * total, contents.file_bytes,
                          "and the compressed buffer views before it"); // also while joined
            tinygltf::Buffer buffer;
            buffer.data = decompressed(code, source);
            const auto length = views[v].at("byteLength").get<std::size_t>();
            if (length > buffer.data.size())
                throw Error("has fewer bytes than its byteLength declares");
            tinygltf::BufferView& view = contents.model.bufferViews[v];
            view.buffer = static_cast<int>(contents.model.buffers.size());
            view.byteOffset = 0;
            view.byteLength = length;
            view.byteStride = views[v].value("byteStride", std::size_t{0});
            views[v]["buffer"] = contents.model.buffers.size();
            views[v]["byteOffset"] = 0;
            contents.model.buffers.push_back(std::move(buffer));
            erase_extension(views[v]);
        } catch (const std::exception& error) {
            throw Error("compressed buffer view " + std::to_string(v) + " " + in_plain_words(error));
        }
    }
    // The compressed data is no longer needed.
    std::vector<bool> used(contents.model.buffers.size(), false);
    for (const tinygltf::BufferView& view : contents.model.bufferViews)
        if (view.buffer >= 0 && static_cast<std::size_t>(view.buffer) < used.size())
            used[static_cast<std::size_t>(view.buffer)] = true;
    for (std::size_t b = 0; b < used.size(); ++b)
        if (!used[b])
            contents.model.buffers[b].data.clear();
    contents.drop_extension(kMeshoptExtension);
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
