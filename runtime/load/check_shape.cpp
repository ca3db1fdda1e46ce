// Checks the structure of a glTF file's JSON: lists, integers, and their number.
#include "runtime/load/check_shape.h"

#include "prt/core/error.h"
#include "runtime/load/allowance.h"
#include "runtime/load/extensions.h"
#include "runtime/load/json_text.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace prt {
namespace {

/// Lists at the top level, and the memory that a parser needs for an element: the maximum of tinygltf 2
/// and of `GltfModel` with its transforms.
constexpr std::pair<const char*, std::size_t> kLists[] = {
    {"accessors", 416}, {"animations", 344}, {"bufferViews", 344}, {"buffers", 352}, {"cameras", 920},
    {"images", 424},    {"materials", 2144}, {"meshes", 344},      {"nodes", 1200},  {"samplers", 312},
    {"scenes", 320},    {"skins", 328},      {"textures", 304}};
constexpr std::size_t kPrimitive = 352, kValue = 152; ///< a primitive, and a value of an extension

/// Members that are indices, counts or lengths in any object.
constexpr std::array<std::string_view, 21> kWholeNumbers = {
    "buffer",  "bufferView",    "byteLength", "byteOffset", "byteStride",
    "camera",  "count",         "index",      "indices",    "inverseBindMatrices",
    "input",   "componentType", "mesh",       "material",   "node",
    "output",  "sampler",       "scene",      "skin",       "source",
    "texCoord"};

/// Prefixes of the extensions whose numbers this program reads; other extensions may use these names
/// differently.
constexpr std::array<std::string_view, 8> kReadExtensions = {
    "PRTKIT_",        kMeshoptExtension, kDracoExtension, "EXT_mesh_gpu_instancing",
    "KHR_materials_", "KHR_texture_",    "EXT_texture_",  "MSFT_texture_"};

bool is_checked(std::string_view extension) {
    return std::any_of(kReadExtensions.begin(), kReadExtensions.end(),
                       [&](std::string_view begin) { return extension.starts_with(begin); });
}

/// Returns whether this member must be an integer. The indices of sparse accessors are an object.
bool is_whole_number(const std::string& key, const Json& value) {
    return std::find(kWholeNumbers.begin(), kWholeNumbers.end(), key) != kWholeNumbers.end() &&
           (key != "indices" || !value.is_object());
}

void check_whole(const Json& value, const std::string& name) {
    // Parsers store indices in an int, and lengths and counts in 64 bits.
    const bool length = name.starts_with("byte") || name == "count";
    const std::uint64_t most = length ? std::uint64_t{1} << 53 : INT_MAX;
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
        throw Error("is damaged glTF: " + name + " is " +
                    value.dump(-1, ' ', true, Json::error_handler_t::replace) +
                    ", but must be an integer in 0.." + std::to_string(most));
}

/// Checks a map from names to indices of accessors or other objects.
void check_attributes(const Json& attributes) {
    if (!attributes.is_object())
        throw Error("is damaged glTF: attributes of a primitive are not an object");
    for (const auto& [name, value] : attributes.items()) {
        if (name.find('\0') != std::string::npos)
            throw Error("is damaged glTF: the name of an attribute contains a zero byte");
        check_whole(value, name);
    }
}

/// Returns the number of values in `json`, including itself.
std::size_t count_values(const Json& json) {
    std::size_t count = 1;
    if (json.is_structured())
        for (const Json& value : json)
            count += count_values(value);
    return count;
}

/// Number of values that a parser stores in extras and extensions: those that the reader takes, and others.
struct FreeValues {
    std::size_t taken = 0, left = 0;
};

/// Checks the numbers in all data below `json` that is read; returns the number of values that a parser
/// stores without conversion.
FreeValues check_values(const Json& json) {
    FreeValues kept;
    const auto add = [&](const FreeValues& below) {
        kept.taken += below.taken;
        kept.left += below.left;
    };
    if (json.is_array()) {
        for (const Json& value : json)
            if (value.is_structured())
                add(check_values(value));
        return kept;
    }
    for (const auto& [key, value] : json.items()) {
        if (key == "extras") {
            kept.left += count_values(value);
        } else if (key == "extensions") {
            for (const auto& [name, extension] : value.items())
                (is_taken_extension(name) ? kept.taken : kept.left) += count_values(extension);
            for (const auto& [name, extension] : value.items())
                if (is_checked(name) && extension.is_structured())
                    check_values(extension);
        } else if (is_whole_number(key, value)) {
            check_whole(value, key);
        } else if (key == "attributes") {
            check_attributes(value);
        } else if (value.is_structured()) {
            add(check_values(value));
        }
    }
    return kept;
}

void check_list(const Json& owner, const char* name) {
    const Json& list = list_of(owner, name);
    if (!list.is_array())
        throw Error(std::string("is damaged glTF: ") + name + " is not a list");
    for (const Json& element : list)
        if (!element.is_object())
            throw Error(std::string("is damaged glTF: ") + name +
                        " contains an element that is not an object");
}

/// Returns the memory that a parser needs for the primitives, in bytes.
double check_primitives(const Json& json) {
    double bytes = 0;
    for (const Json& mesh : list_of(json, "meshes"))
        check_list(mesh, "primitives");
    for_each_primitive(json, [&](const Json& primitive) {
        if (!primitive.contains("attributes") || !primitive["attributes"].is_object())
            throw Error("is damaged glTF: a primitive has no attributes");
        for (const char* name : {"indices", "mode"}) // elsewhere an object, or a string
            if (primitive.contains(name))
                check_whole(primitive[name], name);
        constexpr std::size_t kMapEntry = 80; // name and number
        std::size_t entries = primitive["attributes"].size();
        check_list(primitive, "targets");
        for (const Json& target : list_of(primitive, "targets")) {
            check_attributes(target);
            entries += target.size() + 1;
        }
        bytes += static_cast<double>(kPrimitive + entries * kMapEntry);
    });
    return bytes;
}

} // namespace

bool check_shape(const Json& json, std::size_t text_bytes) {
    double bytes = 0;
    for (const auto& [name, size] : kLists) {
        check_list(json, name);
        bytes += static_cast<double>(list_of(json, name).size() * size);
    }
    constexpr std::size_t kFew = 10'000; // values, of two megabytes
    const FreeValues values = check_values(json);
    bytes += static_cast<double>(values.taken * kValue);
    bytes += check_primitives(json);
    check_allowed(bytes, text_bytes, "its JSON");
    return values.left <= kFew;
}

void check_views(const Json& json) {
    const Json &buffers = list_of(json, "buffers"), &views = list_of(json, "bufferViews");
    for (std::size_t b = 1; b < buffers.size(); ++b)
        if (!buffers[b].contains("uri"))
            throw Error("buffer " + std::to_string(b) + " has no URI");
    for (std::size_t v = 0; v < views.size(); ++v) {
        const std::string name = "buffer view " + std::to_string(v);
        const auto buffer = views[v].at("buffer").get<std::size_t>();
        if (buffer >= buffers.size())
            throw Error(name + " refers to buffer " + std::to_string(buffer) + ", which does not exist");
        const auto size = buffers[buffer].at("byteLength").get<std::size_t>();
        const auto offset = views[v].value("byteOffset", std::size_t{0});
        if (offset > size || views[v].at("byteLength").get<std::size_t>() > size - offset)
            throw Error(name + " reaches outside buffer " + std::to_string(buffer) + ", which has " +
                        std::to_string(size) + " bytes");
    }
}

} // namespace prt
