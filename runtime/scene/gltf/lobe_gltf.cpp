// Reads and writes zonal lobes in glTF files: PRTKIT_lobes of docs/format.md.

#include "prt/gltf/transfer_gltf.h"

#include "runtime/scene/gltf/accessor.h"
#include "runtime/scene/gltf/allowance.h"
#include "runtime/scene/gltf/make_meshes_unique.h"
#include "runtime/scene/gltf/transfer_json.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

namespace prt {
namespace {

constexpr int kLobeVersion = 1;

std::string attribute_name(std::size_t lobe) {
    return "_PRT_LOBE_" + std::to_string(lobe);
}

/// Writes one lobe of the vertices of an array.
std::size_t write_lobe_words(GltfContents& contents, const LobeModel& model, const VertexArray& vertices,
                             std::size_t lobe) {
    std::vector<LobeWord> words(vertices.size());
    for (std::size_t v = 0; v < words.size(); ++v)
        words[v] = model.words[(vertices.first_receiver + v) * model.lobes + lobe];
    return contents.add_accessor(
        {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(words)), sizeof(LobeWord), true)},
         {"componentType", TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE},
         {"count", words.size()},
         {"type", "VEC4"}});
}

void read_lobe_words(const GltfContents& contents, const Json& attributes, const VertexArray& vertices,
                     LobeModel& model) {
    for (std::size_t k = 0; k < model.lobes; ++k) {
        const std::string name = attribute_name(k);
        const int accessor = attributes.at(name).get<int>();
        const auto& description = get_accessor(contents.model, accessor);
        if (description.type != TINYGLTF_TYPE_VEC4 ||
            description.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
            description.count != vertices.size())
            throw Error(name + " must have four unsigned bytes for each of " +
                        std::to_string(vertices.size()) + " vertices");
        const std::vector<std::byte> bytes = read_elements(contents.model, accessor);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            std::memcpy(&model.words[(vertices.first_receiver + v) * model.lobes + k],
                        &bytes[v * sizeof(LobeWord)], sizeof(LobeWord));
    }
}

Json profiles_json(GltfContents& contents, const LobeModel& model) {
    std::vector<float> gains;
    for (const LobeProfile& profile : model.profiles)
        gains.insert(gains.end(), profile.begin(), profile.begin() + model.order);
    Json json = write_float_view(contents, gains);
    json["count"] = model.profiles.size();
    return json;
}

void read_profiles(const GltfContents& contents, const Json& json, LobeModel& model) {
    const auto order = static_cast<std::size_t>(model.order);
    model.profiles.resize(static_cast<std::size_t>(
        whole_number(json.at("count"), "the number of profiles", 1, static_cast<int>(kMaxProfiles))));
    const std::vector<float> gains =
        read_float_view(contents, json, model.profiles.size() * order, kMaxGain, "the profiles of lobes");
    for (std::size_t p = 0; p < model.profiles.size(); ++p)
        std::copy_n(gains.begin() + static_cast<std::ptrdiff_t>(p * order), order, model.profiles[p].begin());
}

LobeRecord read_lobe_record(const Json& json) {
    constexpr int kMax = std::numeric_limits<int>::max();
    const auto number = [&](const char* key) {
        return json.contains(key) ? whole_number(json[key], key, 0, kMax) : 0;
    };
    LobeRecord record{
        .poses = number("poses"), .rays = number("raysPerReceiver"), .bounces = number("bounces")};
    if (json.contains("seed") && !json["seed"].is_number_unsigned())
        throw Error("the seed of the lobes is " + json["seed"].dump() +
                    ", but must be a 64-bit unsigned integer");
    record.seed = json.value("seed", std::uint64_t{0});
    return record;
}

} // namespace

void write_lobes(GltfDocument& document, const Scene& scene, const StoredLobes& lobes) {
    check_lobes(lobes.model);
    named(document, [&](GltfContents& contents) {
        const std::vector<Json*> primitives = make_meshes_unique(contents, scene);
        contents.remove_transfer();
        std::vector<Json> attributes;
        for (const VertexArray& vertices : scene.vertex_arrays) {
            Json& added = attributes.emplace_back(Json::object());
            for (std::size_t k = 0; k < lobes.model.lobes; ++k)
                added[attribute_name(k)] = write_lobe_words(contents, lobes.model, vertices, k);
        }
        for (std::size_t i = 0; i < primitives.size(); ++i)
            (*primitives[i])["attributes"].update(attributes[scene.primitives[i].vertices]);
        extensions_of(contents.json)[kLobeExtension] = {{"version", kLobeVersion},
                                                        {"order", lobes.model.order},
                                                        {"lobes", lobes.model.lobes},
                                                        {"profiles", profiles_json(contents, lobes.model)},
                                                        {"bake",
                                                         {{"poses", lobes.record.poses},
                                                          {"raysPerReceiver", lobes.record.rays},
                                                          {"bounces", lobes.record.bounces},
                                                          {"seed", lobes.record.seed}}}};
        contents.use_extension(kLobeExtension);
    });
}

std::optional<StoredLobes> read_lobes(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) -> std::optional<StoredLobes> {
        const Json* extension = find_extension(contents, kLobeExtension, kLobeVersion);
        if (!extension)
            return std::nullopt;
        StoredLobes stored;
        LobeModel& model = stored.model;
        model.order = whole_number(extension->at("order"), "the order of the lobes", 2, kMaxLobeOrder);
        model.lobes = static_cast<std::size_t>(
            whole_number(extension->at("lobes"), "lobes", 1, static_cast<int>(kMaxLobes)));
        read_profiles(contents, extension->at("profiles"), model);
        stored.record = read_lobe_record(extension->value("bake", Json::object()));
        check_allowed(static_cast<double>(scene.receivers()) *
                          static_cast<double>(model.lobes * sizeof(LobeWord)),
                      contents.file_bytes, "its lobes");
        model.words.resize(scene.receivers() * model.lobes);
        TransferOfVertices read;
        for (const Primitive& primitive : scene.primitives) {
            const Json& attributes = primitive_json(contents, primitive).at("attributes");
            Json own = Json::object();
            for (std::size_t k = 0; k < model.lobes; ++k)
                own[attribute_name(k)] = attributes.value(attribute_name(k), Json());
            if (!read.is_new(primitive, own))
                continue;
            try {
                read_lobe_words(contents, attributes, scene.vertex_arrays[primitive.vertices], model);
            } catch (const std::exception& error) {
                throw Error(primitive_name(primitive) + ": " + in_plain_words(error));
            }
        }
        check_lobes(model);
        return stored;
    });
}

} // namespace prt
