#pragma once

// What the two extensions of prtkit have in common.

#include "gltf/contents.h"
#include "prt/coded_rows.h"
#include "prt/gltf.h"
#include "prt/support/error.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace prt {

Json record_json(const BakeRecord& record);
BakeRecord read_record(const Json& json);

/// The extension `name` at the top level, nothing when the file does not have it. Throws `Error` when it has
/// another version.
const Json* find_extension(const GltfContents& contents, const char* name, int expected_version);

/// Throws `Error` where instances share transfer and are nodes: the scene has more vertices than the file.
void check_one_to_one(const GltfContents& contents);

/// [{"kind": "direct", "channels": 1}, ...]
Json parts_json(const TransferLayout& layout);
/// Order and parts of an extension. Throws `Error` when they make no sense.
TransferLayout read_layout(const Json& extension);

/// JSON of a scene primitive, in a file that holds the scene one to one.
const Json& primitive_json(const GltfContents& contents, const Primitive& primitive);
std::string primitive_name(const Primitive& primitive);

/// What primitives say of the transfer of their vertices: those that share them must say the same.
class TransferOfVertices {
public:
    /// Whether the vertices of `primitive` are new. Throws `Error` where another said something else of them.
    bool is_new(const Primitive& primitive, const Json& said);

private:
    std::map<std::size_t, Json> said_; ///< by vertex array
};

/// `value`, which stands in the file as `name`, as a whole number of `least`..`most`. Throws `Error` where it
/// is none.
int whole_number(const Json& value, const std::string& name, int least, int most);

/// Largest magnitude of a weight that is a float, as `kLargestTransfer` of transfer.
inline constexpr float kLargestWeight = 1e9f;

/// Throws `Error` unless all are finite and at most `largest`.
void check_magnitudes(std::span<const float> values, float largest, const std::string& what);

/// Whether {"bufferView": ..., "componentType": ...} holds float16.
bool is_half(const Json& object);

/// Reads floats of {"bufferView": ..., "componentType": 5126 or 5131} into `to`; throws unless there are as
/// many, all values of transfer.
void read_float_view(const GltfContents& contents, const Json& object, std::span<float> to,
                     const std::string& what);
/// The same of one that `is_half`, as it stands.
void read_half_view(const GltfContents& contents, const Json& object, std::span<std::uint16_t> to,
                    const std::string& what);
/// Reads `count` floats of {"bufferView": ..., "componentType": 5126}; throws unless there are as many, all
/// at most `largest`.
std::vector<float> read_float_view(const GltfContents& contents, const Json& object, std::size_t count,
                                   float largest, const std::string& what);
Json write_float_view(GltfContents& contents, std::span<const float> values);
Json write_half_view(GltfContents& contents, std::span<const float> values);

/// {"bufferView": ..., "drops": [...]}
Json write_row_code(GltfContents& contents, const RowCode& code);
/// Throws `Error` for drops that no code has.
RowCode read_row_code(const GltfContents& contents, const Json& json);
/// Its drops alone.
std::vector<std::uint8_t> read_drops(const Json& json);

/// What `work` makes of the contents; errors get the name of the file.
template <class Document, class Work>
auto named(Document& document, Work&& work) {
    try {
        return work(document.contents());
    } catch (const std::exception& error) { // ours, and those of the JSON library on members of a wrong type
        throw Error(document.contents().path.string() + ": " + in_plain_words(error));
    }
}

} // namespace prt
