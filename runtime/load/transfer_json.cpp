// Common parts of the transfer extensions: the bake record, layouts, and views of floats.
#include "runtime/load/transfer_json.h"

#include "runtime/load/accessor.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace prt {
namespace {

/// Returns the one of `values` whose name is stored at `key`; the first if it is missing.
template <class Enum>
Enum one_of(const Json& json, const char* key, std::initializer_list<Enum> values) {
    const std::string word = json.value(key, to_string(*values.begin()));
    for (const Enum value : values)
        if (word == to_string(value))
            return value;
    throw Error(std::string(key) + " of the bake has an unknown value");
}

TermKind read_kind(const std::string& word) {
    for (const TermKind kind : {TermKind::direct, TermKind::indirect, TermKind::combined, TermKind::lamp})
        if (word == to_string(kind))
            return kind;
    throw Error("the transfer has a term of an unknown kind");
}

TransferTerm read_term(const Json& term) {
    if (term.contains("towards"))
        throw Error("the transfer has a sun among its lamps (\"towards\"), which is no longer supported; "
                    "run prt bake again");
    return {read_kind(term.at("kind").get<std::string>()),
            whole_number(term.at("channels"), "channels", 1, 3), term.value("name", ""),
            term.value("members", std::vector<std::string>())};
}

/// Returns the member `key`, a non-negative integer; 0 if it is missing.
template <class Number>
Number count_or_zero(const Json& json, const char* key) {
    if (!json.contains(key))
        return 0;
    const Json& value = json[key];
    if (!value.is_number_integer() || value < 0 ||
        value.get<std::uint64_t>() > std::uint64_t{std::numeric_limits<Number>::max()})
        throw Error(std::string(key) + " of the bake is " + value.dump() +
                    ", but must be an unsigned integer that fits");
    return value.get<Number>();
}

/// Returns the hash of the receivers: 16 digits; empty if it is missing.
std::string read_hash(const Json& json) {
    if (!json.contains("receivers"))
        return {};
    std::string hash = json["receivers"];
    if (hash.size() != 16 || hash.find_first_not_of("0123456789abcdef") != std::string::npos)
        throw Error("\"receivers\" of the bake is not a hash of 16 hexadecimal digits");
    return hash;
}

/// Returns the bytes of floats, or of float16, with exactly the required size.
std::span<const std::byte> float_bytes(const GltfData& data, const Json& object, std::size_t count,
                                       const std::string& what) {
    const std::size_t size = is_half(object) ? sizeof(std::uint16_t) : sizeof(float);
    const auto bytes = buffer_view_bytes(data.model, object.at("bufferView").get<int>());
    if (count > 0 && bytes.size() != count * size) // a larger view would have another layout; views cannot be
                                                   // empty
        throw Error(what + ": expected " + std::to_string(count * size) + " bytes, but the buffer view has " +
                    std::to_string(bytes.size()));
    return bytes;
}

} // namespace

BakeRecord read_record(const Json& json) {
    BakeRecord record;
    record.method = one_of(json, "method", {BakeMethod::trace, BakeMethod::raster});
    record.backend = one_of(json, "backend", {Backend::cpu, Backend::gpu});
    record.rays = count_or_zero<int>(json, "raysPerReceiver");
    record.bounces = count_or_zero<int>(json, "bounces");
    record.seed = count_or_zero<std::uint64_t>(json, "seed");
    record.receivers = read_hash(json);
    record.sampling_error = json.value("samplingError", 0.0);
    record.endless = json.value("endless", false);
    record.fitted = json.value("fitted", false);
    record.media = json.value("media", std::vector<std::string>());
    if (!(record.sampling_error >= 0))
        throw Error("samplingError of the bake is negative");
    return record;
}

const Json* find_extension(const GltfData& data, const char* name, int expected_version) {
    const Json* extension = extension_of(data.json, name);
    if (!extension)
        return nullptr;
    const Json version = extension->value("version", Json(0));
    if (!version.is_number_integer() || version != expected_version)
        throw Error(std::string(name) + " has version " + version.dump() +
                    ", but this program reads version " + std::to_string(expected_version) +
                    "; write the file again with this version of prt");
    return extension;
}

void check_one_to_one(const GltfData& data) {
    const bool told = extension_of(data.json, kInstancesExtension) != nullptr;
    if (data.separate.empty() && told)
        throw Error("its instances share their transfer, which this function does not support");
    bool drawn = !data.separate.empty();
    if (data.json.contains("nodes"))
        for (const Json& node : data.json["nodes"])
            drawn = drawn || extension_of(node, kInstancesExtension);
    if (drawn && !told)
        throw Error(std::string("nodes have ") + kInstancesExtension +
                    ", but the file does not have this extension");
}

TransferLayout read_layout(const Json& extension) {
    TransferLayout layout{whole_number(extension.at("order"), "order", 1, kMaxOrder), {}};
    const Json& terms = extension.at("terms");
    if (!terms.is_array())
        throw Error("\"terms\" of the transfer is not a list");
    for (const Json& term : terms)
        layout.terms.push_back(read_term(term));
    check_layout(layout);
    return layout;
}

bool TransferOfVertices::is_new(const Primitive& primitive, const Json& said) {
    const auto [before, is_new] = said_.try_emplace(primitive.vertices, said);
    if (before->second != said)
        throw Error(primitive_name(primitive) +
                    " shares its vertices with another primitive, but not the transfer");
    return is_new;
}

int whole_number(const Json& value, const std::string& name, int least, int most) {
    if (!value.is_number_integer() || value < least || value > most)
        throw Error(name + " is " + value.dump(-1, ' ', true, Json::error_handler_t::replace) +
                    ", but must be an integer in " + std::to_string(least) + ".." + std::to_string(most));
    return value.get<int>();
}

void check_magnitudes(std::span<const float> values, float largest, const std::string& what) {
    if (!std::all_of(values.begin(), values.end(),
                     [&](float v) { return std::abs(v) <= largest; })) // rejects
                                                                       // NaN
        throw Error(what + " contain values that are not finite" +
                    (largest < 1e18f ? " or exceed " + std::to_string(static_cast<long long>(largest)) : ""));
}

const Json& primitive_json(const GltfData& data, const Primitive& primitive) {
    return data.json.at("meshes")
        .at(static_cast<std::size_t>(primitive.mesh))
        .at("primitives")
        .at(static_cast<std::size_t>(primitive.primitive));
}

std::string primitive_name(const Primitive& primitive) {
    return "mesh " + std::to_string(primitive.mesh) + " primitive " + std::to_string(primitive.primitive);
}

bool is_half(const Json& object) {
    return object.value("componentType", kFloat) == kHalf;
}

void read_float_view(const GltfData& data, const Json& object, std::span<float> to, const std::string& what) {
    const int type = object.value("componentType", kFloat);
    if (type != kFloat && type != kHalf)
        throw Error(what + " have component type " + std::to_string(type) +
                    ", but must have 5126 (float32) or 5131 (float16)");
    const auto bytes = float_bytes(data, object, to.size(), what);
    if (is_half(object)) {
        for (std::size_t i = 0; i < to.size(); ++i) {
            std::uint16_t half = 0;
            std::memcpy(&half, &bytes[i * sizeof half], sizeof half);
            to[i] = glm::unpackHalf1x16(half);
        }
    } else if (!to.empty()) {
        std::memcpy(to.data(), bytes.data(), to.size_bytes());
    }
    check_magnitudes(to, kMaxTransfer, what);
}

void read_half_view(const GltfData& data, const Json& object, std::span<std::uint16_t> to,
                    const std::string& what) {
    const auto bytes = float_bytes(data, object, to.size(), what);
    if (to.empty())
        return;
    std::memcpy(to.data(), bytes.data(), to.size_bytes());
    for (const std::uint16_t half : to)
        if ((half & 0x7C00) == 0x7C00) // infinite or NaN
            check_magnitudes(std::array{glm::unpackHalf1x16(half)}, kMaxTransfer, what);
}

std::vector<float> read_float_view(const GltfData& data, const Json& object, std::size_t count, float largest,
                                   const std::string& what) {
    const int type = object.value("componentType", kFloat);
    if (type != kFloat)
        throw Error(what + " have component type " + std::to_string(type) + ", but must have 5126 (float32)");
    const auto bytes = float_bytes(data, object, count, what);
    std::vector<float> values(count);
    if (count > 0)
        std::memcpy(values.data(), bytes.data(), count * sizeof(float));
    check_magnitudes(values, largest, what);
    return values;
}

RowCode read_row_code(const GltfData& data, const Json& json) {
    const auto bytes = buffer_view_bytes(data.model, json.at("bufferView").get<int>());
    return {read_drops(json), {bytes.begin(), bytes.end()}};
}

std::vector<std::uint8_t> read_drops(const Json& json) {
    std::vector<std::uint8_t> drops;
    for (const Json& drop : json.at("drops"))
        drops.push_back(
            static_cast<std::uint8_t>(whole_number(drop, "an element of \"drops\"", 0, kMaxRowBits)));
    return drops;
}

} // namespace prt
