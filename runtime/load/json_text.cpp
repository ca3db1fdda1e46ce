// Parses the JSON of a glTF file.
#include "runtime/load/json_text.h"

#include "prt/core/error.h"
#include "runtime/core/support/json_tree.h"

#include <algorithm>
#include <string>
#include <utility>

namespace prt {
namespace {

/// Returns line and column of a byte of the file, both counted from 1.
std::string position_of(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.find_last_of('\n');
    return "line " + std::to_string(line) + ", column " +
           std::to_string(before.size() - (start == std::string_view::npos ? 0 : start + 1));
}

/// Throws if objects and arrays are nested too deeply.
void check_depth(std::string_view text) {
    constexpr int kMaxLevels = 256;
    int level = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"')
            quoted = !quoted;
        else if (quoted)
            i += c == '\\' ? 1 : 0;
        else if (c == '{' || c == '[')
            ++level;
        else if (c == '}' || c == ']')
            --level;
        if (level > kMaxLevels)
            throw Error("contains JSON that is nested more than " + std::to_string(kMaxLevels) +
                        " levels deep, at " + position_of(text, i + 1));
    }
}

} // namespace

Json parse_json(std::string_view text) {
    check_depth(text);
    try {
        Json json = parse_json_tree<Json>(text);
        if (!json.is_object() || !json.contains("asset") || !json["asset"].is_object())
            throw Error("is JSON, but not glTF: it has no \"asset\"");
        const std::string version = json["asset"].value("version", "");
        if (!version.starts_with("2."))
            throw Error("is glTF of version '" + version + "'; only version 2 is supported");
        return json;
    } catch (const nlohmann::json::parse_error& error) {
        throw Error("is damaged: its JSON is invalid at " + position_of(text, error.byte));
    }
}

std::size_t remove_nulls(Json& json) {
    const auto is_open = [](const std::string& key) {
        return key != "extras" && !key.starts_with("PRTKIT_");
    };
    std::size_t removed = 0;
    if (auto* object = json.get_ptr<Json::object_t*>()) {
        for (auto& [key, value] : *object)
            if (is_open(key))
                removed += value.is_null() ? 1 : remove_nulls(value);
        const auto absent = [&](const auto& item) { return item.second.is_null() && is_open(item.first); };
        if (std::any_of(object->begin(), object->end(), absent)) {
            Json::object_t kept; // keys are constant and cannot be moved
            for (auto& item : *object)
                if (!absent(item))
                    kept.push_back({item.first, std::move(item.second)});
            object->swap(kept);
        }
    } else if (auto* array = json.get_ptr<Json::array_t*>()) {
        for (Json& value : *array)
            removed += remove_nulls(value);
    }
    return removed;
}

bool is_taken_extension(std::string_view name) {
    return name.starts_with("KHR_") || name.starts_with("EXT_") || name.starts_with("MSFT_");
}

Json without_unread(const Json& json) {
    Json kept(json.type());
    if (const auto* object = json.get_ptr<const Json::object_t*>()) {
        for (const auto& [key, value] : *object) {
            if (key == "extras")
                continue;
            Json member = key == "extensions" ? Json(value.type()) : without_unread(value);
            if (const auto* extensions = value.get_ptr<const Json::object_t*>();
                key == "extensions" && extensions)
                for (const auto& [name, extension] : *extensions)
                    if (is_taken_extension(name))
                        member.get_ref<Json::object_t&>().emplace_back(name, extension);
            kept.get_ref<Json::object_t&>().emplace_back(key, std::move(member));
        }
    } else if (const auto* array = json.get_ptr<const Json::array_t*>()) {
        for (const Json& value : *array)
            kept.push_back(without_unread(value));
    } else {
        kept = json;
    }
    return kept;
}

double json_bytes(const Json& json) {
    constexpr double kAllocation = 64; // overhead of a string, an array or an object
    double bytes = sizeof(Json);
    if (json.is_string())
        return bytes + kAllocation + static_cast<double>(json.get_ref<const std::string&>().size());
    if (const auto* object = json.get_ptr<const Json::object_t*>())
        for (const auto& [key, value] : *object)
            bytes += sizeof(std::string) + static_cast<double>(key.size()) + json_bytes(value);
    else if (const auto* array = json.get_ptr<const Json::array_t*>())
        for (const Json& value : *array)
            bytes += json_bytes(value);
    return json.is_structured() ? bytes + kAllocation : bytes;
}

} // namespace prt
