#pragma once

// What the two extensions of prtkit have in common.

#include "gltf/contents.h"
#include "prt/gltf.h"
#include "prt/support/error.h"

#include <span>
#include <string>

namespace prt {

Json record_json(const BakeRecord& record);
BakeRecord read_record(const Json& json);

/// The extension `name` at the top level, nothing when the file does not have it. Throws `Error` when it has
/// another version.
const Json* find_extension(const GltfContents& contents, const char* name, int expected_version);

/// Order and channels of an extension. Throws `Error` when they make no sense.
void read_shape(const Json& extension, int& order, int& channels);

/// JSON of a scene primitive, in a file that holds the scene one to one.
const Json& primitive_json(const GltfContents& contents, const Primitive& primitive);
std::string primitive_name(const Primitive& primitive);

/// Whether {"bufferView": ..., "componentType": ...} holds float16.
bool is_half(const Json& object);

/// Reads floats of {"bufferView": ..., "componentType": 5126 or 5131} into `to`; throws unless there are as
/// many, all finite.
void read_float_view(const GltfContents& contents, const Json& object, std::span<float> to,
                     const std::string& what);
std::vector<float> read_float_view(const GltfContents& contents, const Json& object, std::size_t count,
                                   const std::string& what);
Json write_float_view(GltfContents& contents, std::span<const float> values);
Json write_half_view(GltfContents& contents, std::span<const float> values);

/// What `read` makes of the contents; errors get the name of the file.
template <class Read>
auto named(const GltfDocument& document, Read&& read) {
    try {
        return read(document.contents());
    } catch (const std::exception& error) { // ours, and those of the JSON library on members of a wrong type
        throw Error(document.contents().path.string() + ": " + in_plain_words(error));
    }
}

} // namespace prt
