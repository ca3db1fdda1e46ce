// Reads zonal lobes: PRTKIT_lobes of docs/format.md.
#include "runtime/load/lobe_transfer.h"

#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/transfer_json.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace prt {
namespace {

void read_lobe_words(const GltfData& data, const Json& attributes, const VertexArray& vertices,
                     LobeModel& model) {
    for (std::size_t k = 0; k < model.lobes; ++k) {
        const std::string name = lobe_name(k);
        const int accessor = attributes.at(name).get<int>();
        const auto& description = get_accessor(data.model, accessor);
        if (description.components != 4 || description.componentType != kUnsignedByte ||
            description.count != vertices.size())
            throw Error(name + " must have four unsigned bytes for each of " +
                        std::to_string(vertices.size()) + " vertices");
        const std::vector<std::byte> bytes = read_elements(data.model, accessor);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            std::memcpy(&model.words[(vertices.first_receiver + v) * model.lobes + k],
                        &bytes[v * sizeof(LobeWord)], sizeof(LobeWord));
    }
}

void read_profiles(const GltfData& data, const Json& json, LobeModel& model) {
    const auto order = static_cast<std::size_t>(model.order);
    model.profiles.resize(static_cast<std::size_t>(
        whole_number(json.at("count"), "the number of profiles", 1, static_cast<int>(kMaxProfiles))));
    const std::vector<float> gains =
        read_float_view(data, json, model.profiles.size() * order, kMaxGain, "the profiles of lobes");
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

std::string lobe_name(std::size_t lobe) {
    return "_PRT_LOBE_" + std::to_string(lobe);
}

bool has_lobes(const GltfData& data, const GltfPrimitive& primitive) {
    return extension_of(data.json, kLobeExtension) && attribute_of(primitive, lobe_name(0)) >= 0;
}

std::optional<StoredLobes> read_lobes(const GltfData& data, const Scene& scene) {
    const Json* extension = find_extension(data, kLobeExtension, kLobeVersion);
    if (!extension || std::ranges::none_of(scene.vertex_arrays, &VertexArray::lobes))
        return std::nullopt;
    StoredLobes stored;
    LobeModel& model = stored.model;
    model.order = whole_number(extension->at("order"), "the order of the lobes", 2, kMaxLobeOrder);
    model.lobes = static_cast<std::size_t>(
        whole_number(extension->at("lobes"), "lobes", 1, static_cast<int>(kMaxLobes)));
    read_profiles(data, extension->at("profiles"), model);
    stored.record = read_lobe_record(extension->value("bake", Json::object()));
    check_allowed(static_cast<double>(scene.receivers()) *
                      static_cast<double>(model.lobes * sizeof(LobeWord)),
                  data.file_bytes, "its lobes");
    model.words.resize(scene.receivers() * model.lobes);
    TransferOfVertices read;
    for (const Primitive& primitive : scene.primitives) {
        const Json& attributes = primitive_json(data, primitive).at("attributes");
        Json own = Json::object();
        for (std::size_t k = 0; k < model.lobes; ++k)
            own[lobe_name(k)] = attributes.value(lobe_name(k), Json());
        if (!read.is_new(primitive, own) || !scene.vertex_arrays[primitive.vertices].lobes)
            continue;
        try {
            read_lobe_words(data, attributes, scene.vertex_arrays[primitive.vertices], model);
        } catch (const std::exception& error) {
            throw Error(primitive_name(primitive) + ": " + in_plain_words(error));
        }
    }
    check_lobes(model);
    return stored;
}

} // namespace prt
