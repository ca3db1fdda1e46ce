// Reads and writes coded words of vertices in glTF files: PRTKIT_clustered_pca of docs/format.md.
#include "runtime/scene/gltf/coded_vertices.h"

#include "runtime/scene/gltf/accessor.h"
#include "runtime/scene/gltf/allowance.h"
#include "runtime/scene/gltf/changed_file.h"
#include "runtime/scene/gltf/clustered_json.h"
#include "runtime/scene/gltf/triangles.h"
#include "runtime/transfer/coded_words.h"

#include <climits>
#include <cstring>
#include <map>
#include <set>

namespace prt {
namespace {

/// Memory per vertex while its words are decoded, in addition to the words: fields, neighbours and triangles.
constexpr double kBytesPerVertex = 120;

WordLayout word_layout(const GltfContents& contents, const Json& extension) {
    ClusteredTransfer transfer;
    transfer.bases = read_clusters_of(extension);
    read_packing(contents, extension.at("packing"), transfer);
    return {cluster_layouts(transfer.bases), transfer.receivers.cluster_bits, transfer.receivers.words};
}

std::string weights_name(std::size_t word) {
    return "_PRT_WEIGHTS_" + std::to_string(word);
}

/// Calls `visit` with every primitive in the JSON and in the model.
template <class Contents, class Visit>
void for_each_pair(Contents& contents, Visit&& visit) {
    for (std::size_t m = 0; m < contents.model.meshes.size(); ++m)
        for (std::size_t p = 0; p < contents.model.meshes[m].primitives.size(); ++p) {
            const std::string name = "mesh " + std::to_string(m) + " primitive " + std::to_string(p);
            try {
                visit(contents.json.at("meshes").at(m).at("primitives").at(p),
                      contents.model.meshes[m].primitives[p]);
            } catch (const std::exception& error) {
                throw Error(name + ": " + in_plain_words(error));
            }
        }
}

std::size_t vertex_count(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
        throw Error("it has coded words, but no POSITION");
    return get_accessor(model, position->second).count;
}

/// Triangles with vertices numbered over all primitives.
class WordMesh {
public:
    explicit WordMesh(std::size_t vertices) : vertices_(vertices) {}
    void add(const tinygltf::Model& model, const tinygltf::Primitive& primitive, std::size_t first,
             std::size_t count) {
        if (first > vertices_ || count > vertices_ - first)
            throw Error("its coded words " + std::to_string(first) + " to " + std::to_string(first + count) +
                        " reach beyond the " + std::to_string(vertices_) + " coded words of the file");
        for (const glm::uvec3& t : read_triangles(model, primitive, count))
            for (int i = 0; i < 3; ++i)
                triangles_.push_back(static_cast<std::uint32_t>(first) + t[i]);
    }
    std::vector<EarlierNeighbors> neighbors() const { return earlier_neighbors(triangles_, vertices_); }

private:
    std::size_t vertices_;
    std::vector<std::uint32_t> triangles_;
};

/// Returns the first vertex of the coded words of a primitive; empty if it has none.
std::optional<std::size_t> first_vertex(const Json& primitive) {
    const Json* extension = extension_of(primitive, kClusteredExtension);
    if (!extension)
        return std::nullopt;
    return static_cast<std::size_t>(whole_number(extension->at("firstVertex"), "firstVertex", 0, INT_MAX));
}

/// Decodes the words of all vertices.
std::vector<std::uint32_t> decoded(const GltfContents& contents, const Json& json, const WordLayout& layout) {
    const auto vertices = static_cast<std::size_t>(whole_number(json.at("vertices"), "vertices", 1, INT_MAX));
    check_allowed(static_cast<double>(vertices) * (kBytesPerVertex + 16.0 * layout.words),
                  contents.file_bytes, "its coded words");
    WordMesh mesh(vertices);
    for_each_pair(contents, [&](const Json& primitive, const tinygltf::Primitive& model) {
        if (const auto first = first_vertex(primitive))
            mesh.add(contents.model, model, *first, vertex_count(contents.model, model));
    });
    const auto bytes = std::as_bytes(buffer_view_bytes(contents.model, json.at("bufferView").get<int>()));
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

/// Replaces the contents of `view` by `words` [vertices][stride / 4].
void replace_view(GltfContents& contents, std::size_t view, std::span<const std::uint32_t> words,
                  std::size_t stride) {
    std::vector<unsigned char>& buffer = contents.binary();
    buffer.resize((buffer.size() + 7) / 8 * 8);
    const std::size_t begin = buffer.size(), length = words.size_bytes();
    buffer.resize(begin + length);
    std::memcpy(buffer.data() + begin, words.data(), length);
    contents.json["bufferViews"].at(view) = {{"buffer", 0},
                                             {"byteOffset", begin},
                                             {"byteLength", length},
                                             {"byteStride", stride},
                                             {"target", TINYGLTF_TARGET_ARRAY_BUFFER}};
    tinygltf::BufferView& model = contents.model.bufferViews.at(view);
    model.byteOffset = begin;
    model.byteLength = length;
    model.byteStride = stride;
    contents.cut_unused_bytes();
}

/// Adds an accessor to the JSON and the model: one word of `count` vertices.
std::size_t add_words(GltfContents& contents, std::size_t view, std::size_t offset, std::size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(view);
    accessor.byteOffset = offset;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    accessor.count = count;
    accessor.type = TINYGLTF_TYPE_VEC4;
    contents.model.accessors.push_back(accessor);
    return contents.add_accessor({{"bufferView", view},
                                  {"byteOffset", offset},
                                  {"componentType", accessor.componentType},
                                  {"count", count},
                                  {"type", "VEC4"}});
}

void erase_extension(Json& primitive) {
    primitive["extensions"].erase(kClusteredExtension);
    if (primitive["extensions"].empty())
        primitive.erase("extensions");
}

/// Adds the attributes of its coded words, stored in `view`, to every primitive.
void add_attributes(GltfContents& contents, std::size_t view, std::size_t words) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> accessors; // accessors of the first word
    for_each_pair(contents, [&](Json& primitive, tinygltf::Primitive& model) {
        const auto first = first_vertex(primitive);
        if (!first)
            return;
        const std::size_t count = vertex_count(contents.model, model);
        const auto [entry, is_new] = accessors.try_emplace({*first, count}, contents.model.accessors.size());
        for (std::size_t w = 0; w < words; ++w) {
            if (is_new)
                add_words(contents, view, 4 * (*first * words + w), count);
            primitive["attributes"][weights_name(w)] = entry->second + w;
            model.attributes[weights_name(w)] = static_cast<int>(entry->second + w);
        }
        erase_extension(primitive);
    });
}

/// Words of vertex arrays in the order of the primitives.
struct GatheredWords {
    std::map<std::vector<int>, std::size_t> firsts; ///< by the accessors of the words
    std::vector<std::uint32_t> words;
};

std::vector<int> word_accessors(const tinygltf::Primitive& primitive) {
    std::vector<int> accessors;
    for (std::size_t w = 0;; ++w) {
        const auto found = primitive.attributes.find(weights_name(w));
        if (found == primitive.attributes.end())
            return accessors;
        accessors.push_back(found->second);
    }
}

GatheredWords gather_words(const GltfContents& read, std::size_t stride) {
    GatheredWords gathered;
    for_each_pair(read, [&](const Json&, const tinygltf::Primitive& primitive) {
        const std::vector<int> accessors = word_accessors(primitive);
        const std::size_t first = gathered.words.size() / stride;
        if (accessors.size() != stride || !gathered.firsts.try_emplace(accessors, first).second)
            return;
        const std::size_t count = vertex_count(read.model, primitive);
        gathered.words.resize(gathered.words.size() + count * stride);
        for (std::size_t w = 0; w < stride; ++w) {
            const std::vector<std::byte> elements = read_elements(read.model, accessors[w]);
            for (std::size_t v = 0; v < count; ++v)
                std::memcpy(&gathered.words[(first + v) * stride + w], &elements.at(4 * v), 4);
        }
    });
    return gathered;
}

} // namespace

void decode_vertices(GltfContents& contents) {
    const Json* extension = find_extension(contents, kClusteredExtension, kClusteredVersion);
    if (!extension || !extension->contains("packing") || !extension->at("packing").contains("words"))
        return;
    const Json json = extension->at("packing")["words"];
    const WordLayout layout = word_layout(contents, *extension);
    const auto view = json.at("bufferView").get<std::size_t>();
    const auto words = static_cast<std::size_t>(layout.words);
    replace_view(contents, view, decoded(contents, json, layout), 4 * words);
    add_attributes(contents, view, words);
    contents.json["extensions"][kClusteredExtension]["packing"].erase("words");
}

std::optional<GltfContents> with_coded_vertices(const GltfContents& contents, const GltfContents& read) {
    const Json* extension = extension_of(read.json, kClusteredExtension);
    if (!extension || !extension->contains("packing"))
        return std::nullopt;
    const WordLayout layout = word_layout(read, *extension);
    const auto stride = static_cast<std::size_t>(layout.words);
    const GatheredWords gathered = gather_words(read, stride);
    if (gathered.words.empty() || !can_code_words(layout, gathered.words))
        return std::nullopt;
    const std::size_t vertices = gathered.words.size() / stride;
    WordMesh mesh(vertices);
    std::optional<GltfContents> coded = contents;
    std::set<std::size_t> replaced;
    for_each_pair(read, [&](const Json&, const tinygltf::Primitive& model) {
        if (const auto found = gathered.firsts.find(word_accessors(model)); found != gathered.firsts.end())
            mesh.add(read.model, model, found->second, vertex_count(read.model, model));
    });
    std::size_t p = 0;
    std::vector<const tinygltf::Primitive*> primitives;
    for (const tinygltf::Mesh& m : read.model.meshes)
        for (const tinygltf::Primitive& primitive : m.primitives)
            primitives.push_back(&primitive);
    for_each_primitive(coded->json, [&](Json& primitive) {
        const auto found = gathered.firsts.find(word_accessors(*primitives.at(p++)));
        if (found == gathered.firsts.end())
            return;
        for (std::size_t w = 0; w < stride; ++w) {
            replaced.insert(primitive["attributes"].at(weights_name(w)).get<std::size_t>());
            primitive["attributes"].erase(weights_name(w));
        }
        extensions_of(primitive)[kClusteredExtension] = {{"firstVertex", found->second}};
    });
    WordCode code = encode_words(layout, mesh.neighbors(), gathered.words);
    std::vector<std::byte>& bytes = code.frequencies.bits;
    const std::size_t split = bytes.size();
    bytes.insert(bytes.end(), code.bits.begin(), code.bits.end());
    coded->json["extensions"][kClusteredExtension]["packing"]["words"] = {
        {"vertices", vertices},
        {"bufferView", coded->add_buffer_view(bytes)},
        {"frequencies", {{"byteLength", split}, {"drops", code.frequencies.drops}}}};
    coded->remove_unused(std::move(replaced));
    return coded;
}

} // namespace prt
