// Reads JSON files and checks the types of members.

#include "json_file.h"

#include "prt/support/error.h"
#include "prt/support/file.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace prt::cli {

Json read_json(const std::filesystem::path& path) {
    const std::vector<std::byte> file = read_file(path);
    const char* begin = reinterpret_cast<const char*>(file.data());
    try { // the words of the library name its inner parts
        return Json::parse(begin, begin + file.size());
    } catch (const Json::parse_error& error) {
        throw Error(fmt::format("is no JSON from byte {} on", error.byte));
    } catch (const Json::exception&) {
        throw Error("holds a number beyond those of doubles");
    }
}

const Json& member(const Json& object, const char* key) {
    if (!object.is_object() || !object.contains(key))
        throw Error(fmt::format("\"{}\" is missing", key));
    return object[key];
}

double number(const Json& object, const char* key) {
    const Json& value = member(object, key);
    if (!value.is_number())
        throw Error(fmt::format("\"{}\" is no number", key));
    return value.get<double>();
}

double number_in(const Json& object, const char* key, double low, double high) {
    const double value = number(object, key);
    if (!(value >= low && value <= high))
        throw Error(fmt::format("\"{}\" is not in {:.5g}..{:.5g}", key, low, high));
    return value;
}

std::vector<float> numbers(const Json& object, const char* key, std::size_t count) {
    const Json& list = member(object, key);
    if (!list.is_array())
        throw Error(fmt::format("\"{}\" is no list of numbers", key));
    if (list.size() != count)
        throw Error(fmt::format("\"{}\" has {} numbers and needs {}", key, list.size(), count));
    std::vector<float> values;
    for (const Json& value : list) {
        if (!value.is_number())
            throw Error(fmt::format("\"{}\" is no list of numbers", key));
        values.push_back(value.get<float>());
        if (!std::isfinite(values.back()))
            throw Error(fmt::format("\"{}\" holds what is no finite float", key));
    }
    return values;
}

glm::vec3 vector_of(const Json& object, const char* key) {
    const std::vector<float> values = numbers(object, key, 3);
    return {values[0], values[1], values[2]};
}

glm::vec3 direction_of(const Json& object, const char* key) {
    const glm::dvec3 towards(vector_of(object, key));
    const double length = glm::length(towards);
    if (!(length > 0))
        throw Error(fmt::format("\"{}\" is no direction", key));
    return glm::vec3(towards / length);
}

} // namespace prt::cli
