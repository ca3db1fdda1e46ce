#pragma once

// Files of JSON, with errors in our words. Needs nlohmann-json. Experimental.

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace prt::json {

using Json = nlohmann::ordered_json;

/// Throws `Error` for what is no JSON; it does not name the file.
Json read_json(const std::filesystem::path& path);

/// A member of `object`, which throws `Error` with its key unless it is such.
const Json& member(const Json& object, const char* key);
double number(const Json& object, const char* key);
/// In [low, high].
double number_in(const Json& object, const char* key, double low, double high);
/// `count` finite floats.
std::vector<float> numbers(const Json& object, const char* key, std::size_t count);
glm::vec3 vector_of(const Json& object, const char* key);
/// Made unit.
glm::vec3 direction_of(const Json& object, const char* key);

} // namespace prt::json
