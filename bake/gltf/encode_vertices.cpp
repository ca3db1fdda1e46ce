// Writes coded words of vertices in glTF files: docs/format.md.
#include "bake/gltf/encode_vertices.h"

#include "runtime/load/accessor.h"
#include "runtime/load/coded_vertices.h"
#include "runtime/load/receiver_sets.h"

#include <cstring>
#include <map>
#include <set>

namespace prt {
namespace {

/// Words of vertex arrays in the order of the primitives.
struct GatheredWords {
    std::map<std::vector<int>, std::size_t> firsts; ///< by the accessors of the words
    std::vector<std::uint32_t> words;
};

std::vector<int> word_accessors(const GltfPrimitive& primitive) {
    std::vector<int> accessors;
    for (std::size_t w = 0;; ++w) {
        const auto found = primitive.attributes.find(weights_name(w));
        if (found == primitive.attributes.end())
            return accessors;
        accessors.push_back(found->second);
    }
}

GatheredWords gather_words(const GltfData& read, std::size_t stride) {
    GatheredWords gathered;
    for_each_pair(read, [&](const Json&, const GltfPrimitive& primitive) {
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

std::optional<GltfContents> with_coded_vertices(const GltfContents& contents, const GltfData& read) {
    const Json* set = find_set(read, ReceiverKind::vertices, Coding::clustered);
    if (!set || !set->contains("packing"))
        return std::nullopt;
    const WordLayout layout = word_layout(read, *set);
    const auto stride = static_cast<std::size_t>(layout.words);
    const GatheredWords gathered = gather_words(read, stride);
    if (gathered.words.empty() || !can_code_words(layout, gathered.words))
        return std::nullopt;
    const std::size_t vertices = gathered.words.size() / stride;
    WordMesh mesh(vertices);
    std::optional<GltfContents> coded = contents;
    std::set<std::size_t> replaced;
    for_each_pair(read, [&](const Json&, const GltfPrimitive& model) {
        if (const auto found = gathered.firsts.find(word_accessors(model)); found != gathered.firsts.end())
            mesh.add(read.model, model, found->second, vertex_count(read.model, model));
    });
    std::size_t p = 0;
    std::vector<const GltfPrimitive*> primitives;
    for (const GltfMesh& m : read.model.meshes)
        for (const GltfPrimitive& primitive : m.primitives)
            primitives.push_back(&primitive);
    for_each_primitive(coded->json, [&](Json& primitive) {
        const auto found = gathered.firsts.find(word_accessors(*primitives.at(p++)));
        if (found == gathered.firsts.end())
            return;
        for (std::size_t w = 0; w < stride; ++w) {
            replaced.insert(primitive["attributes"].at(weights_name(w)).get<std::size_t>());
            primitive["attributes"].erase(weights_name(w));
        }
        member(extensions_of(primitive), kTransferExtension, Json::value_t::object)["firstVertex"] =
            found->second;
    });
    WordCode code = encode_words(layout, mesh.neighbors(), gathered.words);
    std::vector<std::byte>& bytes = code.frequencies.bits;
    const std::size_t split = bytes.size();
    bytes.insert(bytes.end(), code.bits.begin(), code.bits.end());
    const std::size_t view = coded->add_buffer_view(bytes);
    (*find_set_to_decode(*coded))["packing"]["words"] = {
        {"vertices", vertices},
        {"bufferView", view},
        {"frequencies", {{"byteLength", split}, {"drops", code.frequencies.drops}}}};
    coded->remove_unused(std::move(replaced));
    return coded;
}

} // namespace prt
