#pragma once

#include <cstddef>
#include <vector>

namespace prt::test {

/// A .glb in memory as prt compress writes it: one triangle, two clusters of random bases.
std::vector<std::byte> lit_model();

} // namespace prt::test
