// Finds contents of a file that are not read.
#include "bake/gltf/unread.h"

#include "bake/gltf/contents.h"
#include "runtime/load/supported_extensions.h"

#include <set>

namespace prt {
namespace {

std::string light_name(const Json& light, std::size_t index) {
    const std::string name = light.is_object() ? light.value("name", "") : "";
    return "light " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

} // namespace

std::vector<std::string> unread_extensions(const GltfDocument& document) {
    std::vector<std::string> unread;
    const Json& json = document.contents().json;
    if (const auto used = json.find("extensionsUsed"); used != json.end() && used->is_array())
        for (const Json& name : *used)
            if (name.is_string() && !is_supported_extension(name.get<std::string>()))
                unread.push_back(name.get<std::string>());
    return unread;
}

std::vector<std::string> unused_lights(const GltfDocument& document) {
    const Json& json = document.contents().json;
    std::vector<std::string> unused;
    const Json* extension = extension_of(json, "KHR_lights_punctual");
    if (!extension || !extension->contains("lights"))
        return unused;
    std::set<std::size_t> used;
    if (const auto nodes = json.find("nodes"); nodes != json.end())
        for (const Json& node : *nodes)
            if (const Json* light = extension_of(node, "KHR_lights_punctual");
                light && light->contains("light") && light->at("light").is_number_unsigned())
                used.insert(light->at("light").get<std::size_t>());
    const Json& lights = extension->at("lights");
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (!used.contains(i))
            unused.push_back(light_name(lights[i], i));
    return unused;
}

} // namespace prt
