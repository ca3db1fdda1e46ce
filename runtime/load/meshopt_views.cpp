// Decompresses buffer views with EXT_meshopt_compression.
#include "runtime/load/meshopt_views.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/extensions.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <string>

namespace prt {
namespace {

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

void decompress_views(GltfData& data) {
    Json& views = data.json["bufferViews"];
    double total = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
        const Json* extension = extension_of(views[v], kMeshoptExtension);
        if (!extension)
            continue;
        const auto view_bytes = buffer_view_bytes(data.model, static_cast<int>(v));
        try {
            const std::span source(reinterpret_cast<const unsigned char*>(view_bytes.data()),
                                   view_bytes.size());
            const MeshoptCode code = read_code(*extension);
            total += static_cast<double>(code.count) * static_cast<double>(code.stride);
            check_allowed(2 * total, data.file_bytes,
                          "and the compressed buffer views before it"); // also while joined
            GltfBuffer buffer;
            buffer.data = decompressed(code, source);
            const auto length = views[v].at("byteLength").get<std::size_t>();
            if (length > buffer.data.size())
                throw Error("has fewer bytes than its byteLength declares");
            GltfBufferView& view = data.model.bufferViews[v];
            view.buffer = static_cast<int>(data.model.buffers.size());
            view.byteOffset = 0;
            view.byteLength = length;
            view.byteStride = views[v].value("byteStride", std::size_t{0});
            views[v]["buffer"] = data.model.buffers.size();
            views[v]["byteOffset"] = 0;
            data.model.buffers.push_back(std::move(buffer));
            erase_extension(views[v], kMeshoptExtension);
        } catch (const std::exception& error) {
            throw Error("compressed buffer view " + std::to_string(v) + " " + in_plain_words(error));
        }
    }
    // The compressed data is no longer needed.
    std::vector<bool> used(data.model.buffers.size(), false);
    for (const GltfBufferView& view : data.model.bufferViews)
        if (view.buffer >= 0 && static_cast<std::size_t>(view.buffer) < used.size())
            used[static_cast<std::size_t>(view.buffer)] = true;
    for (std::size_t b = 0; b < used.size(); ++b)
        if (!used[b])
            data.model.buffers[b].data.clear();
    drop_extension(data.json, kMeshoptExtension);
}

} // namespace prt
