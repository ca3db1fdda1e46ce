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

/// Reads JSON. Throws `Error` for invalid JSON; the error does not contain the file name.
Json read_json(const std::filesystem::path& path);

/// Returns a member of `object`. Throws `Error` with its key if it is missing or has another type.
const Json& member(const Json& object, const char* key);
/// Returns a finite number.
double number(const Json& object, const char* key);
/// Returns a number in [low, high].
double number_in(const Json& object, const char* key, double low, double high);
/// Returns `count` finite floats.
std::vector<float> numbers(const Json& object, const char* key, std::size_t count);
glm::vec3 vector_of(const Json& object, const char* key);
/// Returns a vector, normalised.
glm::vec3 direction_of(const Json& object, const char* key);

} // namespace json
} // namespace prt
