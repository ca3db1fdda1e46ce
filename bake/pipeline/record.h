#pragma once

// Result of a bake, with its record and statistics.

#include "bake/pipeline/direct.h"
#include "bake/pipeline/light_transport.h"
#include "prt/bake/bake.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Receivers of the scene that are sealed in, and their repair.
struct SealedIn {
    std::vector<std::uint32_t> receivers; ///< ascending
    std::size_t rays = 0;                 ///< rays that found them
    Refill refill;
};

/// Creates the result with its record and its statistics, except `seconds` and values that depend on it.
/// Selects the storage format.
BakeResult record(const BakePlan& plan, const Tracer& tracer, const DirectLight& direct,
                  const SealedIn& sealed, Propagated exit);

/// Relative L2 error of `transfer` rounded to float16.
double float16_rounding_error(const Transfer& transfer, std::span<const float> areas);

/// Relative L2 errors.
struct StorageErrors {
    double rounding, sampling; ///< error of rounding to float16; error of the rays
};

/// Returns `asked`, or else float16 if its rounding is negligible against the noise, with a notice. Throws
/// `Error` if float16 is asked and some coefficient exceeds its range.
TransferStorage storage_for(const std::optional<TransferStorage>& asked, const StorageErrors& errors,
                            std::vector<std::string>& notices);
/// Throws `Error` for an infinite error of rounding to float16.
void check_float16(double rounding_error);

} // namespace prt
