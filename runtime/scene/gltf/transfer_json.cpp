// What both transfer extensions share: the record of the bake, shapes, and views of floats.
#include "gltf/transfer_json.h"

#include "gltf/accessor.h"
#include "prt/sh.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace prt {
namespace {

/// GL_HALF_FLOAT. glTF's accessors do not know it, but the views of our extensions are no accessors.
constexpr int kHalfComponentType = 5131;

/// The one of `values` whose word stands at `key`, the first where there is none.
template <class Enum>
Enum one_of(const Json& json, const char* key, std::initializer_list<Enum> values) {
    const std::string word = json.value(key, to_string(*values.begin()));
    for (const Enum value : values)
        if (word == to_string(value))
            return value;
    throw Error(std::string(key) + " of the bake is a word that this program does not know");
}

} // namespace

Json record_json(const BakeRecord& record) {
    return {{"method", to_string(record.method)},
            {"backend", to_string(record.backend)},
            {"raysPerReceiver", record.rays},
            {"bounces", record.bounces},
            {"seed", record.seed},
            {"receivers", record.receivers},
            {"samplingError", record.sampling_error}};
}

BakeRecord read_record(const Json& json) {
    BakeRecord record;
    record.method = one_of(json, "method", {BakeMethod::trace, BakeMethod::raster});
    record.backend = one_of(json, "backend", {Backend::cpu, Backend::gpu});
    record.rays = json.value("raysPerReceiver", 0);
    record.bounces = json.value("bounces", 0);
    record.seed = json.value("seed", std::uint64_t{0});
    record.receivers = json.value("receivers", "");
    record.sampling_error = json.value("samplingError", 0.0);
    return record;
}

const Json* find_extension(const GltfContents& contents, const char* name, int expected_version) {
    if (!contents.json.contains("extensions") || !contents.json["extensions"].contains(name))
        return nullptr;
    const Json& extension = contents.json["extensions"][name];
    const int version = extension.value("version", 0);
    if (version != expected_version)
        throw Error(std::string(name) + " has version " + std::to_string(version) + ", this program reads " +
                    std::to_string(expected_version));
    return &extension;
}

void read_shape(const Json& extension, int& order, int& channels) {
    order = extension.at("order").get<int>();
    check_order(order);
    channels = extension.at("channels").get<int>();
    if (channels != 1 && channels != 3)
        throw Error("has " + std::to_string(channels) + " channels, only 1 or 3 make sense");
}

const Json& primitive_json(const GltfContents& contents, const Primitive& primitive) {
    return contents.json.at("meshes")
        .at(static_cast<std::size_t>(primitive.mesh))
        .at("primitives")
        .at(static_cast<std::size_t>(primitive.primitive));
}

std::string primitive_name(const Primitive& primitive) {
    return "mesh " + std::to_string(primitive.mesh) + " primitive " + std::to_string(primitive.primitive);
}

bool is_half(const Json& object) {
    return object.value("componentType", TINYGLTF_COMPONENT_TYPE_FLOAT) == kHalfComponentType;
}

void read_float_view(const GltfContents& contents, const Json& object, std::span<float> to,
                     const std::string& what) {
    const int type = object.value("componentType", TINYGLTF_COMPONENT_TYPE_FLOAT);
    if (type != TINYGLTF_COMPONENT_TYPE_FLOAT && type != kHalfComponentType)
        throw Error(what + " are of component type " + std::to_string(type) +
                    ", neither 5126 (float32) nor 5131 (float16)");
    const std::size_t size = is_half(object) ? sizeof(std::uint16_t) : sizeof(float);
    const auto bytes = buffer_view_bytes(contents.model, object.at("bufferView").get<int>());
    if (bytes.size() < to.size() * size)
        throw Error(what + " need " + std::to_string(to.size() * size) + " bytes, but there are " +
                    std::to_string(bytes.size()));
    if (is_half(object)) {
        for (std::size_t i = 0; i < to.size(); ++i) {
            std::uint16_t half = 0;
            std::memcpy(&half, &bytes[i * sizeof half], sizeof half);
            to[i] = glm::unpackHalf1x16(half);
        }
    } else if (!to.empty()) {
        std::memcpy(to.data(), bytes.data(), to.size_bytes());
    }
    if (!std::all_of(to.begin(), to.end(), [](float v) { return std::isfinite(v); }))
        throw Error(what + " hold values that are not finite");
}

std::vector<float> read_float_view(const GltfContents& contents, const Json& object, std::size_t count,
                                   const std::string& what) {
    std::vector<float> values(count);
    read_float_view(contents, object, values, what);
    return values;
}

Json write_float_view(GltfContents& contents, std::span<const float> values) {
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(values))},
            {"componentType", TINYGLTF_COMPONENT_TYPE_FLOAT}};
}

Json write_half_view(GltfContents& contents, std::span<const float> values) {
    std::vector<std::uint16_t> halves(values.size());
    std::transform(values.begin(), values.end(), halves.begin(), glm::packHalf1x16);
    return {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(halves)))},
            {"componentType", kHalfComponentType}};
}

} // namespace prt
