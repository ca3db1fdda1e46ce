// Reads coded words of vertices in glTF files: docs/format.md.
#include "runtime/load/coded_vertices.h"

#include "prt/core/error.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/changed_file.h"
#include "runtime/load/clustered_set.h"
#include "runtime/load/extensions.h"
#include "runtime/load/receiver_sets.h"
#include "runtime/load/transfer_json.h"
#include "runtime/load/triangles.h"

#include <climits>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace prt {
namespace {

/// Memory per vertex while its words are decoded, in addition to the words: fields, neighbours and triangles.
constexpr double kBytesPerVertex = 120;

/// Returns the first vertex of the coded words of a primitive; empty if it has none.
std::optional<std::size_t> first_vertex(const Json& primitive) {
    const Json* extension = extension_of(primitive, kTransferExtension);
    if (!extension || !extension->contains("firstVertex"))
        return std::nullopt;
    return static_cast<std::size_t>(whole_number(extension->at("firstVertex"), "firstVertex", 0, INT_MAX));
}

/// Throws `Error` if the triangles of all primitives with coded words need too much memory: primitives can
/// share accessors, and accessors need no data.
void check_triangles(const GltfData& data) {
    constexpr double kBytesPerIndex = 24; // the index, its triangle and its neighbours
    double bytes = 0;
    for_each_pair(data, [&](const Json& primitive, const GltfPrimitive& model) {
        if (!first_vertex(primitive))
            return;
        const std::size_t indices = model.indices >= 0 ? get_accessor(data.model, model.indices).count
                                                       : vertex_count(data.model, model);
        const double corners = model.mode == kTriangles ? 1 : 3;
        bytes += kBytesPerIndex * corners * static_cast<double>(indices);
    });
    check_allowed(bytes, data.file_bytes, "the triangles of its coded words");
}

/// Decodes the words of all vertices.
std::vector<std::uint32_t> decoded(const GltfData& data, const Json& json, const WordLayout& layout) {
    const auto vertices = static_cast<std::size_t>(whole_number(json.at("vertices"), "vertices", 1, INT_MAX));
    check_allowed(static_cast<double>(vertices) * (kBytesPerVertex + 16.0 * layout.words), data.file_bytes,
                  "its coded words");
    check_triangles(data);
    WordMesh mesh(vertices);
    for_each_pair(data, [&](const Json& primitive, const GltfPrimitive& model) {
        if (const auto first = first_vertex(primitive))
            mesh.add(data.model, model, *first, vertex_count(data.model, model));
    });
    const auto bytes = buffer_view_bytes(data.model, json.at("bufferView").get<int>());
    const Json& frequencies = json.at("frequencies");
    const auto split = static_cast<std::size_t>(
        whole_number(frequencies.at("byteLength"), "the length of the frequencies", 0, INT_MAX));
    if (split > bytes.size())
        throw Error("the frequencies of the coded words end too early");
    const auto middle = bytes.begin() + static_cast<std::ptrdiff_t>(split);
    const WordCode words{{read_drops(frequencies), {bytes.begin(), middle}}, {middle, bytes.end()}};
    try {
        return decode_words(words, layout, mesh.neighbors());
    } catch (const Error& error) { // they are predicted from neighbours of the mesh as it was compressed
        throw Error(error.what() + std::string(kCompressAgain));
    }
}

/// Makes `words` [vertices][stride / 4] the contents of `view`, in a new buffer.
void replace_view(GltfData& data, std::size_t view, std::span<const std::uint32_t> words,
                  std::size_t stride) {
    const std::size_t length = words.size_bytes(), buffer = data.model.buffers.size();
    const auto* begin = reinterpret_cast<const unsigned char*>(words.data());
    data.model.buffers.push_back({{begin, begin + length}});
    data.json["bufferViews"].at(view) = {{"buffer", buffer},
                                         {"byteOffset", 0},
                                         {"byteLength", length},
                                         {"byteStride", stride},
                                         {"target", kArrayBuffer}};
    data.model.bufferViews.at(view) = {static_cast<int>(buffer), 0, length, stride};
}

/// Adds an accessor to the JSON and the model: one word of `count` vertices.
void add_words(GltfData& data, std::size_t view, std::size_t offset, std::size_t count) {
    GltfAccessor accessor;
    accessor.bufferView = static_cast<int>(view);
    accessor.byteOffset = offset;
    accessor.componentType = kUnsignedByte;
    accessor.count = count;
    accessor.components = 4;
    data.model.accessors.push_back(accessor);
    member(data.json, "accessors", Json::value_t::array)
        .push_back({{"bufferView", view},
                    {"byteOffset", offset},
                    {"componentType", accessor.componentType},
                    {"count", count},
                    {"type", "VEC4"}});
}

/// Adds the attributes of its coded words, stored in `view`, to every primitive.
void add_attributes(GltfData& data, std::size_t view, std::size_t words) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> accessors; // accessors of the first word
    for_each_pair(data, [&](Json& primitive, GltfPrimitive& model) {
        const auto first = first_vertex(primitive);
        if (!first)
            return;
        const std::size_t count = vertex_count(data.model, model);
        const auto [entry, is_new] = accessors.try_emplace({*first, count}, data.model.accessors.size());
        for (std::size_t w = 0; w < words; ++w) {
            if (is_new)
                add_words(data, view, 4 * (*first * words + w), count);
            primitive["attributes"][weights_name(w)] = entry->second + w;
            model.attributes[weights_name(w)] = static_cast<int>(entry->second + w);
        }
        Json& extension = primitive["extensions"][kTransferExtension];
        extension.erase("firstVertex");
        if (extension.empty())
            erase_extension(primitive, kTransferExtension);
    });
}

} // namespace

WordLayout word_layout(const GltfData& data, const Json& set) {
    const ClusteredTransfer transfer = read_clusters(data, set);
    return {cluster_layouts(transfer.bases), transfer.receivers.cluster_bits, transfer.receivers.words};
}

std::string weights_name(std::size_t group) {
    return "_PRT_WEIGHTS_" + std::to_string(group);
}

std::size_t vertex_count(const GltfModel& model, const GltfPrimitive& primitive) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
        throw Error("it has coded words, but no POSITION");
    return get_accessor(model, position->second).count;
}

void WordMesh::add(const GltfModel& model, const GltfPrimitive& primitive, std::size_t first,
                   std::size_t count) {
    if (first > vertices_ || count > vertices_ - first)
        throw Error("its coded words " + std::to_string(first) + " to " + std::to_string(first + count) +
                    " reach beyond the " + std::to_string(vertices_) + " coded words of the file");
    for (const glm::uvec3& t : read_triangles(model, primitive, count))
        for (int i = 0; i < 3; ++i)
            triangles_.push_back(static_cast<std::uint32_t>(first) + t[i]);
}

bool decode_vertices(GltfData& data) {
    Json* set = find_set_to_decode(data);
    if (!set || !set->contains("packing") || !set->at("packing").contains("words"))
        return false;
    const Json json = set->at("packing")["words"];
    (*set)["packing"].erase("words");
    const WordLayout layout = word_layout(data, *set);
    const auto view = json.at("bufferView").get<std::size_t>();
    const auto words = static_cast<std::size_t>(layout.words);
    replace_view(data, view, decoded(data, json, layout), 4 * words);
    add_attributes(data, view, words);
    return true;
}

} // namespace prt
