#pragma once

// JSON of glTF files.

#include <nlohmann/json.hpp>

#include <exception>
#include <string>

namespace prt {

using Json = nlohmann::ordered_json;

/// Returns the message of an exception without the internal prefixes of libraries, as one line of printable
/// characters.
std::string in_plain_words(const std::exception& error);

/// Calls `visit` with every primitive of every mesh, in file order.
template <class AnyJson, class Visit>
void for_each_primitive(AnyJson& json, Visit&& visit) {
    if (json.contains("meshes"))
        for (auto& mesh : json["meshes"])
            if (mesh.contains("primitives"))
                for (auto& primitive : mesh["primitives"])
                    visit(primitive);
}

/// Returns the list `name` of `owner`; an empty list if it is missing.
const Json& list_of(const Json& owner, const char* name);

/// Returns the member `key` of `object`; creates it if it does not exist. `object[key][..]` is unsafe: if
/// memory runs out while a null becomes an object, it is left without members and cannot be destroyed
/// (nlohmann-json 3.11).
Json& member(Json& object, const char* key, Json::value_t type);
/// Returns the extension `name` of `object`; null if it does not exist.
const Json* extension_of(const Json& object, const char* name);
Json& extensions_of(Json& object);
/// Removes the extension `name` of `object`, and `extensions` if it was the last one.
void erase_extension(Json& object, const char* name);
/// Removes `name` from `list`, extensionsUsed or extensionsRequired of a file, and the list if it was the
/// last name.
void erase_name(Json& json, const char* list, const std::string& name);
/// Removes `name` from extensionsUsed and extensionsRequired of a file.
void drop_extension(Json& json, const std::string& name);

} // namespace prt
