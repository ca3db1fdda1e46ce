#pragma once

// Reads JSON files with clear errors. Needs nlohmann-json. Experimental.

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace prt {

using Json = nlohmann::ordered_json;

namespace json {

/// Reads a JSON file. Throws `Error` for invalid JSON; the message does not contain the file name.
Json read_json(const std::filesystem::path& path);

/// Returns member `key` of `object`. Throws `Error` with the key if it is missing; the functions below also
/// throw it if the member has another type or is out of range.
const Json& member(const Json& object, const char* key);
/// Returns member `key`, a finite number. Throws `Error` for any other value.
double number(const Json& object, const char* key);
/// Returns a member that is a number in [low, high].
double number_in(const Json& object, const char* key, double low, double high);
/// Returns a member that is a list of `count` finite floats.
std::vector<float> numbers(const Json& object, const char* key, std::size_t count);
/// Returns a member that is a list of three finite floats.
glm::vec3 vector_of(const Json& object, const char* key);
/// Returns a member that is a direction, normalised. Throws `Error` if its length is 0.
glm::vec3 direction_of(const Json& object, const char* key);

} // namespace json
} // namespace prt
