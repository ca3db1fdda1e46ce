#pragma once

// Traversal of material references.

namespace prt {

/// Calls `visit` with all objects that may name a material of a primitive: the primitive, and the mappings of
/// its variants.
template <class AnyJson, class Visit>
void for_each_choice(AnyJson& primitive, Visit&& visit) {
    visit(primitive);
    if (!primitive.contains("extensions") || !primitive["extensions"].contains("KHR_materials_variants"))
        return;
    auto& variants = primitive["extensions"]["KHR_materials_variants"];
    if (variants.contains("mappings"))
        for (auto& mapping : variants["mappings"])
            visit(mapping);
}

} // namespace prt
