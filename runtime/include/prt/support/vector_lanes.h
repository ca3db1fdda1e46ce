#pragma once

// Portable SIMD code: 16 floats as one value, and functions compiled for several vector widths. Experimental.

namespace prt {

inline constexpr int kLaneCount = 16;

/// 16 floats; the compiler maps them to the available registers.
using Lanes [[gnu::vector_size(sizeof(float) * kLaneCount)]] = float;

/// 16 floats in memory, with the alignment of float; may alias an array of float.
using LanesInMemory
    [[gnu::vector_size(sizeof(float) * kLaneCount), gnu::aligned(alignof(float)), gnu::may_alias]] = float;

// Clang loses the alignment behind a reference; gcc copies values of this size.
#ifdef __clang__
using LanesRead = Lanes;
#else
using LanesRead = const LanesInMemory&;
#endif

/// Returns 16 consecutive floats.
[[gnu::always_inline]] inline LanesRead lanes_at(const float* values) {
    return *reinterpret_cast<const LanesInMemory*>(values);
}

/// `Width` floats as a value and in memory. Sums that stay in registers during many additions must not be
/// wider than a register: gcc splits wider values through memory.
template <int Width>
struct Floats {
    using Value [[gnu::vector_size(sizeof(float) * Width)]] = float;
    using InMemory [[gnu::vector_size(sizeof(float) * Width), gnu::aligned(alignof(float)), gnu::may_alias]] =
        float;
};

/// Returns `Width` consecutive floats.
template <int Width>
[[gnu::always_inline]] inline typename Floats<Width>::Value floats_at(const float* values) {
    return *reinterpret_cast<const typename Floats<Width>::InMemory*>(values);
}

inline constexpr int kNarrow = 8; ///< number of floats in a register of most processors

} // namespace prt

// Functions with these attributes are compiled for several vector widths and selected at run time, so that a
// portable build uses the full width of the processor. A clone affects only inlined code; helpers are
// therefore [[gnu::always_inline]]. Sanitizers cannot instrument the resolver that runs before them.
// PRTKIT_NO_CLONES: one width, for builds that need not be fast (CMake's PRTKIT_CLONES).
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) &&                 \
    !defined(__SANITIZE_ADDRESS__) && !defined(PRTKIT_NO_CLONES)
#define PRT_TARGET_CLONES [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
// For long code that benefits little from the widest vectors.
#define PRT_TWO_CLONES [[gnu::target_clones("arch=x86-64-v3", "default")]]
// Only for registers of kLaneCount floats; call only if prt::has_wide_registers().
#define PRT_WIDE_TARGET [[gnu::target("arch=x86-64-v4")]]
#define PRT_HAS_WIDE_REGISTERS                                                                               \
    (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&                              \
     __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&                             \
     __builtin_cpu_supports("avx512cd"))
#else
#define PRT_TARGET_CLONES
#define PRT_TWO_CLONES
#define PRT_WIDE_TARGET
#define PRT_HAS_WIDE_REGISTERS false
#endif

namespace prt {

/// Returns whether functions of PRT_WIDE_TARGET may be called.
inline bool has_wide_registers() {
    return PRT_HAS_WIDE_REGISTERS;
}

} // namespace prt
