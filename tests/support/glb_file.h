#pragma once

#include "prt/load/scene.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace prt::test {

/// Builds small glTF files, right or wrong, by hand.
struct GlbFile {
    nlohmann::ordered_json json = {{"asset", {{"version", "2.0"}}}};
    std::vector<std::byte> binary;

    /// Appends data, a buffer view (stride 0: none) and an accessor on it; returns the accessor.
    template <class T>
    std::size_t accessor(const std::vector<T>& values, int component_type, const char* type,
                         std::size_t components, bool normalized = false, std::size_t stride = 0) {
        return accessor(std::as_bytes(std::span(values)), values.size() / components, component_type, type,
                        normalized, stride);
    }
    std::size_t accessor(std::span<const std::byte> bytes, std::size_t count, int component_type,
                         const char* type, bool normalized, std::size_t stride);
    std::size_t view(std::span<const std::byte> bytes, std::size_t stride = 0);

    std::string bytes() const;
    void write(const std::filesystem::path& path) const;
};

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                     kUnsignedInt = 5125, kFloat = 5126;

/// Parses a .glb into its parts.
GlbFile glb_of(std::span<const std::byte> bytes);
GlbFile read_glb(const std::filesystem::path& path);

/// Returns the set of `receivers` ("vertices", "texels" or "probes") in PRTKIT_transfer. Throws without one.
nlohmann::ordered_json& set_of(nlohmann::ordered_json& json, std::string_view receivers);
const nlohmann::ordered_json& set_of(const nlohmann::ordered_json& json, std::string_view receivers);

/// A file with one triangle (0,0,0) (1,0,0) (0,1,0), indexed, with normals, at node 0.
GlbFile triangle_file();

/// A file with the one vertex array and the one primitive of `scene`, white.
GlbFile scene_file(const Scene& scene);

} // namespace prt::test
