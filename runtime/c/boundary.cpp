#include "boundary.h"

#include "prt/sh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace prt::c {

static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

void say(prt_message* message, const char* text) noexcept {
    if (!message)
        return;
    const std::size_t length = std::min(std::strlen(text), sizeof message->text - 1);
    std::memcpy(message->text, text, length);
    message->text[length] = 0;
}

std::size_t count_of(int order) {
    check_order(order);
    return static_cast<std::size_t>(coefficient_count(order));
}

/// Without a way out of the loop it runs in vectors.
bool within(float most, const float* values, std::size_t count) {
    bool inside = true;
    for (std::size_t i = 0; i < count; ++i)
        inside &= std::abs(values[i]) <= most; // nor is NaN
    return inside;
}

bool finite(const float* values, std::size_t count) {
    return within(std::numeric_limits<float>::max(), values, count);
}

} // namespace prt::c
