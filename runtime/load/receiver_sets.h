#pragma once

// Sets of receivers in a file: PRTKIT_transfer of docs/format.md.

#include "runtime/load/gltf_data.h"

namespace prt {

inline constexpr int kTransferVersion = 6;

/// Receivers of a set.
enum class ReceiverKind { vertices, texels, probes };
/// Form of the transfer of a set.
enum class Coding { raw, clustered };

/// Returns the name in files.
const char* to_string(ReceiverKind kind);
/// Returns the name in files.
const char* to_string(Coding coding);

/// Returns the set of these receivers; null if the file has none. Throws `Error` if the file has transfer of
/// a former version of prtkit, or if the list of sets is invalid.
const Json* find_set(const GltfData& data, ReceiverKind kind);
/// Returns the set of these receivers if it has this coding; null otherwise. Throws the errors of the
/// function above.
const Json* find_set(const GltfData& data, ReceiverKind kind, Coding coding);

/// Returns whether the file has a set of vertices or texels. Throws the errors of `find_set`.
bool has_surface_transfer(const GltfData& data);

/// Returns the set of vertices if its transfer is clustered, for functions that change it; null without
/// such a set, or if the file has raw transfer of a former version, which a bake replaces. Throws `Error` for
/// compressed transfer of a former version, and the errors of `find_set`.
Json* find_set_to_decode(GltfData& data);

} // namespace prt
