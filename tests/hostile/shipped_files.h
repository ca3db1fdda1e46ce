#pragma once

#include "support/glb_file.h"

#include <string>
#include <vector>

namespace prt::test {

struct ShippedFile {
    std::string name;
    GlbFile file;
};

/// Valid shipped files of every kind, made anew: each choice of guides, bits that are fixed and free, weights
/// of floats and of bytes, rows that are coded and plain, lamps, quantised normals, nodes that mirror,
/// lightmaps.
std::vector<ShippedFile> shipped_files();

/// A triangle with a volume whose bases are plain, and one whose bases are coded.
std::vector<ShippedFile> volume_files();

} // namespace prt::test
