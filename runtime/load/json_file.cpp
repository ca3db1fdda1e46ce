// Reads JSON files and checks the types of members.

#include "runtime/load/json_file.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/file.h"
#include "runtime/core/support/json_tree.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <sstream>
#include <string>

namespace prt::json {
namespace {

std::string quoted(const char* key) {
    return "\"" + std::string(key) + "\"";
}

} // namespace

Json read_json(const std::filesystem::path& path) {
    const std::vector<std::byte> file = read_file(path);
    const char* begin = reinterpret_cast<const char*>(file.data());
    try { // the words of the library name its inner parts
        return parse_json_tree<Json>({begin, file.size()});
    } catch (const Json::parse_error& error) {
        throw Error("is not valid JSON: the error is at byte " + std::to_string(error.byte));
    } catch (const Json::exception&) {
        throw Error("contains a number that does not fit into a double");
    }
}

const Json& member(const Json& object, const char* key) {
    if (!object.is_object() || !object.contains(key))
        throw Error(quoted(key) + " is missing");
    return object[key];
}

double number(const Json& object, const char* key) {
    const Json& value = member(object, key);
    if (!value.is_number())
        throw Error(quoted(key) + " is not a number");
    return value.get<double>();
}

double number_in(const Json& object, const char* key, double low, double high) {
    const double value = number(object, key);
    if (value >= low && value <= high)
        return value;
    std::ostringstream range;
    range.precision(5);
    range << quoted(key) << " is not in the range " << low << ".." << high;
    throw Error(range.str());
}

std::vector<float> numbers(const Json& object, const char* key, std::size_t count) {
    const Json& list = member(object, key);
    if (!list.is_array())
        throw Error(quoted(key) + " is not a list of numbers");
    if (list.size() != count)
        throw Error(quoted(key) + " has " + counted(list.size(), "number") + ", but needs " +
                    std::to_string(count));
    std::vector<float> values;
    for (const Json& value : list) {
        if (!value.is_number())
            throw Error(quoted(key) + " is not a list of numbers");
        values.push_back(value.get<float>());
        if (!std::isfinite(values.back()))
            throw Error(quoted(key) + " contains a number that is not a finite float");
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
        throw Error(quoted(key) + " is not a direction: its length is 0 or not finite");
    return glm::vec3(towards / length);
}

} // namespace prt::json
