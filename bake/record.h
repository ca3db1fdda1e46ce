#pragma once

// What a bake hands out.

#include "direct.h"
#include "transport/light_transport.h"

namespace prt {

/// Receivers of the scene that are sealed in, and what becomes of them.
struct SealedIn {
    std::vector<std::uint32_t> receivers; ///< ascending
    std::size_t rays = 0;                 ///< traced to find out
    Refill refill;
};

/// The result with its record and its statistics, but for `seconds` and what follows from them. Decides on
/// the storage.
BakeResult record(const BakePlan& plan, const Tracer& tracer, const DirectLight& direct,
                  const SealedIn& sealed, Propagated exit);

/// Relative L2 error of `transfer` rounded to float16.
double float16_rounding_error(const Transfer& transfer, std::span<const float> areas);

/// Relative L2.
struct StorageErrors {
    double rounding, sampling; ///< of float16; of the rays
};

/// Float16 where its rounding is lost in the noise, with a notice.
TransferStorage storage_for(const StorageErrors& errors, std::vector<std::string>& notices);

} // namespace prt
