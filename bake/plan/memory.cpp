// Estimates the bytes of a bake before they are allocated: the system would end a bake that does not fit
// after most of its work.

#include "bake/plan/memory.h"

#include "bake/plan/available_memory.h"
#include "prt/bake/bake_options.h"
#include "prt/core/error.h"
#include "prt/core/sh_basis.h"
#include "runtime/core/support/counted.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt {
namespace {

double memory_there(const BakeOptions& options) {
    return available_memory(options.memory.limit);
}

double memory_needed(const BakePlan& plan) {
    return estimate_memory(plan.options, plan.receivers().size(), plan.scene.surfaces().triangles(),
                           plan.numbers());
}

} // namespace

double estimate_memory(const BakeOptions& options, std::size_t receivers, std::size_t triangles,
                       std::size_t numbers) {
    const auto count = static_cast<double>(receivers);
    const double vector = 4.0 * static_cast<double>(numbers);
    // The transfer itself, a copy in the file being written, and a copy joined to the file.
    double bytes = 3 * count * vector;
    if (options.target_error)
        bytes += 3 * count * vector;
    // Embree's hierarchy of high quality, our tables of triangles, the scene, its neighbours.
    bytes += 400.0 * static_cast<double>(triangles) + 150 * count;
    // The solver processes all light together, in at most three channels.
    const double solved = std::min(3.0, static_cast<double>(numbers) / coefficient_count(options.order));
    if (options.bounces == kEndlessBounces)
        bytes +=
            40 * count * 4 * solved * coefficient_count(std::min(options.order, 3)); // the solver's steps
    else if (options.bounces != 0)
        bytes += 2 * count * vector;
    return bytes;
}

bool fits_memory(const BakePlan& plan, double more) {
    return memory_needed(plan) + more <= memory_there(plan.options);
}

void check_memory(const BakePlan& plan, double more) {
    const double there = memory_there(plan.options), needed = memory_needed(plan) + more;
    if (there > 0 && needed > there)
        throw Error(fmt::format(
            "the bake needs about {:.2g} GB of memory ({}, order {}, {}{}), "
            "but {} {:.2g} GB; reduce the order or the number of rays",
            needed * 1e-9, counted(plan.receivers().size(), "receiver"), plan.options.order,
            counted(plan.options.rays, "ray"), plan.bounces != 0 ? ", with bounces" : "",
            plan.options.memory.limit > 0 ? "the limit is" : "the machine has only", there * 1e-9));
}

} // namespace prt
