#pragma once

// Boundary between C and C++: converts exceptions to statuses and messages, and checks pointers and numbers.

#include "prt/core/error.h"
#include "prt/core/transfer_layout.h"
#include "prt/prt.h"
#include "prt/shader/shader_source.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <new>
#include <span>
#include <string>

namespace prt::c {

/// Error in a file. A separate type distinguishes it from a bad argument.
struct BadFile : Error {
    using Error::Error;
};

struct TooSmall : Error {
    using Error::Error;
};

void say(prt_message* message, const char* text) noexcept;

/// Runs `body` and converts its exceptions to a status and a message.
template <class Body>
prt_status guarded(prt_message* message, Body&& body) noexcept {
    try {
        say(message, "");
        body();
        return PRT_OK;
    } catch (const std::bad_alloc&) {
        say(message, "out of memory");
        return PRT_NO_MEMORY;
    } catch (const BadFile& error) {
        say(message, error.what());
        return PRT_BAD_FILE;
    } catch (const TooSmall& error) {
        say(message, error.what());
        return PRT_TOO_SMALL;
    } catch (const Error& error) {
        say(message, error.what());
        return PRT_BAD_ARGUMENT;
    } catch (const std::exception& error) { // from a library, or a bug in prtkit
        say(message, error.what());
        return PRT_INTERNAL;
    }
}

/// Runs `body`, which reads a file, and converts its `Error` to `BadFile`.
template <class Body>
void as_file(Body&& body) {
    try {
        body();
    } catch (const Error& error) {
        throw BadFile(error.what());
    }
}

template <class... Pointers>
void check_pointers(const Pointers*... pointers) {
    const bool any_null = (... || (pointers == nullptr));
    if (any_null)
        throw Error("a required pointer is null");
}

/// Returns the number of coefficients of an order. Throws `Error` if the order is invalid.
std::size_t count_of(int order);

/// Returns whether all values are in -most..most.
bool within(float most, const float* values, std::size_t count);
bool finite(const float* values, std::size_t count);

/// Maximum magnitude of light coefficients and of constants.
inline constexpr float kBrightest = 1e20f, kMaxConstant = 1e30f;

inline glm::vec3* colors(float* light) {
    return reinterpret_cast<glm::vec3*>(light); // vec3 is exactly three floats
}

inline std::span<const glm::vec3> light_colors(const float* from, std::size_t count) {
    return {reinterpret_cast<const glm::vec3*>(from), count};
}

/// Coefficients of a sky and its suns, [order²], and strengths of lamps; `suns` and `lamps` may be null.
struct LightArguments {
    int order;
    const float *sky, *suns, *lamps;
};

/// Throws `Error` for an invalid order and for light that is not finite or exceeds kBrightest.
LightingView lighting_of(const LightArguments& light, std::size_t lamps);

/// Writes `text` with its final 0 to `source`, and its size to `*size`. Throws `TooSmall`.
void write_text(const std::string& text, char* source, std::size_t* size);

/// Converts a prt_language, whose values equal those of ShaderLanguage. Throws `Error` for others.
ShaderLanguage language_of(int language);

} // namespace prt::c
