// The C interface: spherical harmonics functions.

#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "runtime/c/boundary.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

namespace {

using namespace prt::c;
using prt::Error;

constexpr std::size_t kMaxCoefficients = prt::kMaxOrder * prt::kMaxOrder;

/// Checks the coefficients of an input or output function.
void check_function(const float* function, std::size_t count) {
    if (!finite(function, count))
        throw Error(
            "the coefficients of a function must be finite, and products of them must fit into a float");
}

glm::vec3 direction_of(const float* xyz) {
    const double length = glm::length(glm::dvec3(glm::make_vec3(xyz)));
    if (!(length > 0 && std::isfinite(length)))
        throw Error("a direction has length " + std::to_string(length) + ", but must be finite and not 0");
    return glm::make_vec3(xyz);
}

} // namespace

extern "C" {

prt_status prt_sh_evaluate(int order, const float direction[3], float* basis, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(direction, basis);
        const std::size_t count = count_of(order);
        std::array<float, kMaxCoefficients> values;
        prt::evaluate_sh(order, direction_of(direction), std::span(values).first(count));
        check_function(values.data(), count);
        std::copy_n(values.begin(), count, basis);
    });
}

prt_status prt_sh_multiply(int order, const float* a, const float* b, float* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(a, b, out);
        const std::size_t count = count_of(order);
        check_function(a, count);
        check_function(b, count);
        std::array<float, kMaxCoefficients> product;
        prt::sh_product(order, std::span(a, count), std::span(b, count), std::span(product).first(count));
        check_function(product.data(), count);
        std::copy_n(product.begin(), count, out);
    });
}

prt_status prt_sh_rotate(int order, const float rotation[9], const float* in, float* out,
                         prt_message* message) {
    return guarded(message, [&] {
        check_pointers(rotation, in, out);
        const std::size_t count = count_of(order);
        check_function(in, count);
        std::array<float, kMaxCoefficients> rotated;
        prt::ShRotation(order, glm::dmat3(glm::make_mat3(rotation)))
            .apply(std::span(in, count), std::span(rotated).first(count));
        check_function(rotated.data(), count);
        std::copy_n(rotated.begin(), count, out);
    });
}

} // extern "C"
