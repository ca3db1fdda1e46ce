// Members and extensions of glTF's JSON.
#include "runtime/load/json.h"

#include "prt/core/error.h"
#include "runtime/core/support/printable.h"

#include <new>
#include <stdexcept>

namespace prt {

const Json& list_of(const Json& owner, const char* name) {
    static const Json kNothing = Json::array();
    const auto list = owner.find(name);
    return list == owner.end() ? kNothing : *list;
}

Json& member(Json& object, const char* key, Json::value_t type) {
    if (!object.contains(key))
        object[key] = Json(type);
    return object[key];
}

const Json* extension_of(const Json& object, const char* name) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end())
        return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() ? nullptr : &*found;
}

Json& extensions_of(Json& object) {
    return member(object, "extensions", Json::value_t::object);
}

void erase_extension(Json& object, const char* name) {
    object["extensions"].erase(name);
    if (object["extensions"].empty())
        object.erase("extensions");
}

void erase_name(Json& json, const char* list, const std::string& name) {
    if (!json.contains(list))
        return;
    Json kept = Json::array();
    for (const Json& other : json[list])
        if (other != name)
            kept.push_back(other);
    if (kept.empty())
        json.erase(list);
    else
        json[list] = std::move(kept);
}

void drop_extension(Json& json, const std::string& name) {
    erase_name(json, "extensionsUsed", name);
    erase_name(json, "extensionsRequired", name);
}

std::string in_plain_words(const std::exception& error) {
    std::string what = printable(one_line(error.what()));
    if (dynamic_cast<const nlohmann::json::exception*>(
            &error)) // "[json.exception.type_error.302] type must be .."
        return "is damaged glTF: " + what.substr(what.starts_with("[json") ? what.find("] ") + 2 : 0);
    if (dynamic_cast<const std::out_of_range*>(&error))
        return "is damaged glTF: an index is out of range";
    if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error))
        return "there is not enough memory to read the file";
    return what.empty() ? "is damaged glTF" : what;
}

} // namespace prt
