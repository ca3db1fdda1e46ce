#pragma once

// Clamping of factors.

#include <cstddef>
#include <map>
#include <string>

namespace prt {

/// Clamps values that glTF requires in 0..1, because light that grows at every bounce diverges. Records the
/// changes.
class UnitRange {
public:
    /// Clamps all components; NaN becomes 0. `name`: property and owner, "baseColorFactor of materials".
    template <class Vector>
    void clamp(Vector& values, const char* name) {
        bool changed = false;
        for (int c = 0; c < Vector::length(); ++c)
            changed |= clamp_component(values[c]);
        count_if(changed, name);
    }
    void clamp(float& value, const char* name) { count_if(clamp_component(value), name); }

    /// Returns one line about all clamped values; empty if absent.
    std::string notice() const;

private:
    static bool clamp_component(float& value);
    void count_if(bool changed, const char* name) {
        if (changed)
            ++clamped_[name];
    }
    std::map<std::string, std::size_t> clamped_;
};

} // namespace prt
