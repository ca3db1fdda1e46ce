#pragma once

// Reads JSON files with clear errors. Needs nlohmann-json. Experimental.

#include "runtime/load/json.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace prt {

namespace json {

/// Returns the content of a JSON file. Throws `Error` if the file cannot be read, is not valid JSON, or
/// contains a number that does not fit into a double. Messages about the content do not contain the file
/// name.
Json read_json(const std::filesystem::path& path);

/// Returns a reference to member `key` of `object`. Throws `Error`, with the key, if the member is missing or
/// `object` is not a JSON object.
const Json& member(const Json& object, const char* key);
/// Returns member `key` of `object`, a number. Throws `Error`, with the key, if the member is missing or is
/// not a number.
double number(const Json& object, const char* key);
/// Returns member `key` of `object`, a number in [low, high]. Throws `Error`, with the key, if the member is
/// missing, is not a number, or is out of this range.
double number_in(const Json& object, const char* key, double low, double high);
/// Returns member `key` of `object`, a list of exactly `count` numbers. Throws `Error`, with the key, if the
/// member is missing, is not a list of numbers, has another length, or contains a number that is not finite
/// as a float.
std::vector<float> numbers(const Json& object, const char* key, std::size_t count);
/// Returns member `key` of `object`, a list of three numbers. Throws `Error`, with the key, if the member is
/// missing, is not a list of numbers, has another length, or contains a number that is not finite as a float.
glm::vec3 vector_of(const Json& object, const char* key);
/// Returns member `key` of `object`, a list of three numbers, scaled to a vector of length 1. Throws the
/// errors of `vector_of`, and `Error`, with the key, if the length of the vector in the file is 0.
glm::vec3 direction_of(const Json& object, const char* key);

} // namespace json
} // namespace prt
