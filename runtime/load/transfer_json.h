#pragma once

// Reads the common JSON of the transfer extensions of prtkit.

#include "prt/core/baked_transfer.h"
#include "prt/core/clustered_bases.h"
#include "prt/core/error.h"
#include "prt/load/scene.h"
#include "runtime/load/extensions.h"
#include "runtime/load/gltf_data.h"
#include "runtime/load/predictors.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace prt {

BakeRecord read_record(const Json& json);

/// Returns the extension `name` at the top level; null if the file does not have it. Throws `Error` for
/// another version.
const Json* find_extension(const GltfData& data, const char* name, int expected_version);

/// Throws `Error` if instances share transfer and are represented as nodes: the scene then has more vertices
/// than the file.
void check_one_to_one(const GltfData& data);

/// Reads order and terms of an extension. Throws `Error` if they are invalid.
TransferLayout read_layout(const Json& extension);

/// Returns the JSON of a scene primitive, in a file in which each vertex is one vertex of the scene.
const Json& primitive_json(const GltfData& data, const Primitive& primitive);
std::string primitive_name(const Primitive& primitive);

/// Consistency check of primitives that share vertices: their transfer must be described equally.
class TransferOfVertices {
public:
    /// Returns whether the vertices of `primitive` are new. Throws `Error` if another primitive described
    /// them differently.
    bool is_new(const Primitive& primitive, const Json& said);

private:
    std::map<std::size_t, Json> said_; ///< by vertex array
};

/// Returns `value`, stored in the file as `name`, as an integer in `least`..`most`. Throws `Error` otherwise.
int whole_number(const Json& value, const std::string& name, int least, int most);

/// Throws `Error` unless all values are finite with magnitudes of at most `largest`.
void check_magnitudes(std::span<const float> values, float largest, const std::string& what);

/// Returns whether {"bufferView": ..., "componentType": ...} holds float16. glTF accessors do not support it,
/// but the views of prtkit's extensions are not accessors.
bool is_half(const Json& object);

/// Reads floats of {"bufferView": ..., "componentType": 5126 or 5131} into `to`; throws unless the number
/// matches and all values are valid transfer.
void read_float_view(const GltfData& data, const Json& object, std::span<float> to, const std::string& what);
/// Reads float16 values without conversion, if `is_half`; throws unless the number matches and all values are
/// valid transfer.
void read_half_view(const GltfData& data, const Json& object, std::span<std::uint16_t> to,
                    const std::string& what);
/// Reads `count` floats of {"bufferView": ..., "componentType": 5126}; throws unless the number matches and
/// all are at most `largest`.
std::vector<float> read_float_view(const GltfData& data, const Json& object, std::size_t count, float largest,
                                   const std::string& what);

/// Reads a row code. Throws `Error` for invalid drops.
RowCode read_row_code(const GltfData& data, const Json& json);
/// Reads the member `drops` of a row code.
std::vector<std::uint8_t> read_drops(const Json& json);

} // namespace prt
