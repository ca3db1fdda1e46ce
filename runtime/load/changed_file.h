#pragma once

namespace prt {

/// Remedy for transfer whose attributes or vertices another program has rewritten, moved or dropped.
inline constexpr const char* kCompressAgain =
    ": another program has changed the file; run that program before prt bake, or run prt compress again";

} // namespace prt
