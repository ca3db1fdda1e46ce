#pragma once

// Formatting of define lines and GLSL literals.

#include <glm/vec3.hpp>

#include <cstddef>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>
#include <string>

namespace prt {

inline std::string define(const char* name, const std::string& value) {
    return std::string("#define ") + name + " " + value + "\n";
}

inline std::string define(const char* name, std::size_t value) {
    return define(name, std::to_string(value));
}

/// Returns `value` as a GLSL literal with all significant digits of a float.
inline std::string glsl_number(double value) {
    std::ostringstream text;
    text.imbue(std::locale::classic()); // programs may have set a locale with decimal commas
    text << std::scientific << std::setprecision(std::numeric_limits<float>::max_digits10 - 1)
         << static_cast<float>(value);
    return text.str();
}

inline std::string glsl_vector(const glm::dvec3& v) {
    return "vec3(" + glsl_number(v.x) + ", " + glsl_number(v.y) + ", " + glsl_number(v.z) + ")";
}

inline std::string glsl_vector(const glm::ivec3& v) {
    return "ivec3(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
}

} // namespace prt
