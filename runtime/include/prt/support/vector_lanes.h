#pragma once

// Portable vector code: 16 floats as one value, and functions compiled for several vector widths.
// Experimental.

namespace prt {

inline constexpr int kLaneCount = 16;

/// 16 floats; the compiler maps them to the registers that there are.
using Lanes [[gnu::vector_size(sizeof(float) * kLaneCount)]] = float;

/// The same in memory, at the alignment of float and over an array of float.
using LanesInMemory
    [[gnu::vector_size(sizeof(float) * kLaneCount), gnu::aligned(alignof(float)), gnu::may_alias]] = float;

// Clang forgets the alignment behind a reference; gcc copies values of this size.
#ifdef __clang__
using LanesRead = Lanes;
#else
using LanesRead = const LanesInMemory&;
#endif

/// 16 consecutive floats.
[[gnu::always_inline]] inline LanesRead lanes_at(const float* values) {
    return *reinterpret_cast<const LanesInMemory*>(values);
}

/// `Width` floats, and the same in memory. Sums that stay in registers while much is added want no more than
/// a register holds: gcc takes wider values apart through memory.
template <int Width>
struct Floats {
    using Value [[gnu::vector_size(sizeof(float) * Width)]] = float;
    using InMemory [[gnu::vector_size(sizeof(float) * Width), gnu::aligned(alignof(float)), gnu::may_alias]] =
        float;
};

/// `Width` consecutive floats.
template <int Width>
[[gnu::always_inline]] inline typename Floats<Width>::Value floats_at(const float* values) {
    return *reinterpret_cast<const typename Floats<Width>::InMemory*>(values);
}

inline constexpr int kNarrow = 8; ///< floats that a register of most processors holds

} // namespace prt

// Functions marked so are compiled for several vector widths and chosen at run time, so that a portable build
// uses what the processor has. A clone reaches only what is inlined into it: its helpers are
// [[gnu::always_inline]]. Sanitizers cannot instrument the resolver that runs before them. PRTKIT_NO_CLONES:
// one width, for builds that need not be fast (CMake's PRTKIT_CLONES).
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) &&                 \
    !defined(__SANITIZE_ADDRESS__) && !defined(PRTKIT_NO_CLONES)
#define PRT_TARGET_CLONES [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
// For long code that gains little from the widest vectors.
#define PRT_TWO_CLONES [[gnu::target_clones("arch=x86-64-v3", "default")]]
// For registers of kLaneCount floats alone, where prt::has_wide_registers().
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

/// Whether functions of PRT_WIDE_TARGET may be called.
inline bool has_wide_registers() {
    return PRT_HAS_WIDE_REGISTERS;
}

} // namespace prt
