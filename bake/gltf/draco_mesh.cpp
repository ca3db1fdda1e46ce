// Decodes a compressed mesh by Google's Draco decoder.
#include "bake/gltf/draco_mesh.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/accessor.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace prt {
namespace {

/// Decodes a number of the header: versions before 2.2 used 32 bits.
bool decode_number(draco::DecoderBuffer& buffer, std::uint32_t& number) {
    return buffer.bitstream_version() < DRACO_BITSTREAM_VERSION(2, 2) ? buffer.Decode(&number)
                                                                      : draco::DecodeVarint(&number, &buffer);
}

/// Returns the number of triangles in the header of the data; 0 if the header cannot be read. See the Draco
/// bitstream specification, sections 3 to 5.
std::uint32_t claimed_triangles(std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok())
        return 0;
    buffer.set_bitstream_version(
        static_cast<std::uint16_t>(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor)));
    draco::GeometryMetadata metadata;
    if ((header.flags & METADATA_FLAG_MASK) != 0 &&
        !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
        return 0;
    std::uint8_t traversal = 0;
    std::uint32_t vertices = 0, triangles = 0;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        const bool old = buffer.bitstream_version() < DRACO_BITSTREAM_VERSION(2, 2);
        if (!buffer.Decode(&traversal) || (old && !decode_number(buffer, vertices)) ||
            !decode_number(buffer, vertices))
            return 0;
    }
    return decode_number(buffer, triangles) ? triangles : 0;
}

/// Limits the number of triangles, because the decoder allocates memory for all of them before it reads them.
void check_claims(std::span<const std::byte> bytes) {
    constexpr std::size_t kAlwaysFits = std::size_t{1} << 20;
    // The maximum measured value is 194: a flat grid of 131 072, with corners at quantisation steps.
    constexpr std::size_t kMaxTrianglesPerByte = 1024;
    const std::size_t triangles = claimed_triangles(bytes);
    if (triangles > std::max(kAlwaysFits, kMaxTrianglesPerByte * bytes.size()))
        throw Error("its Draco data claims " + std::to_string(triangles) + " triangles, but has only " +
                    counted(bytes.size(), "byte"));
}

/// Appends `value` to `to`.
template <class Value>
void append(std::vector<std::byte>& to, Value value) {
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    to.insert(to.end(), bytes, bytes + sizeof value);
}

/// Throws unless every point has a value.
void check_values(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
    const bool mapped = attribute.is_mapping_identity() || attribute.indices_map_size() >= mesh.num_points();
    for (draco::PointIndex point(0); mapped && point < mesh.num_points(); ++point)
        if (attribute.mapped_index(point).value() >= attribute.size())
            throw Error("its Draco data has points without values");
    if (!mapped)
        throw Error("its Draco data has points without values");
}

} // namespace

std::unique_ptr<draco::Mesh> decode_draco(std::span<const std::byte> bytes) {
    check_claims(bytes);
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok())
        throw Error("its Draco data is damaged: " + mesh.status().error_msg_string());
    return std::move(mesh).value();
}

std::vector<std::byte> draco_indices(const draco::Mesh& mesh, int component_type) {
    std::vector<std::byte> bytes;
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& point : mesh.face(face)) {
            if (component_type == kUnsignedShort)
                append(bytes, static_cast<std::uint16_t>(point.value()));
            else
                append(bytes, point.value());
        }
    return bytes;
}

DracoAttribute draco_attribute(const draco::Mesh& mesh, int id, int component_type, int components) {
    const draco::PointAttribute* attribute =
        id < 0 ? nullptr : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (!attribute)
        throw Error("its Draco data has no attribute " + std::to_string(id));
    if (attribute->num_components() != components)
        throw Error("its Draco data has " + std::to_string(attribute->num_components()) +
                    " components for attribute " + std::to_string(id) + ", but its accessor has " +
                    std::to_string(components));
    check_values(mesh, *attribute);
    DracoAttribute data;
    with_component_type(component_type, [&](auto type) {
        std::vector<decltype(type)> element(static_cast<std::size_t>(components));
        data.stride = (element.size() * sizeof type + 3) / 4 * 4;
        data.bytes.reserve(data.stride * mesh.num_points());
        for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
            if (!attribute->ConvertValue(attribute->mapped_index(point), static_cast<std::int8_t>(components),
                                         element.data()))
                throw Error("its Draco data cannot be converted to the type of the accessor of attribute " +
                            std::to_string(id));
            for (const auto value : element)
                append(data.bytes, value);
            data.bytes.resize((data.bytes.size() + 3) / 4 * 4);
            const std::vector<double> values(element.begin(), element.end());
            if (data.low.empty())
                data.low = data.high = values;
            for (std::size_t c = 0; c < values.size(); ++c) {
                data.low[c] = std::min(data.low[c], values[c]);
                data.high[c] = std::max(data.high[c], values[c]);
            }
        }
    });
    return data;
}

} // namespace prt
