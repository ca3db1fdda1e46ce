#pragma once

// Types and attributes for portable SIMD code: 16 floats as one value, and functions that are compiled for
// several vector widths. Requires GCC or Clang. Experimental.

namespace prt {

/// Number of floats in `Lanes`.
inline constexpr int kLaneCount = 16;

/// 16 floats with element-wise operators. The compiler distributes the floats to registers of the processor's
/// width. Has the alignment of the whole vector.
using Lanes [[gnu::vector_size(sizeof(float) * kLaneCount)]] = float;

/// 16 consecutive floats in memory: for access to any part of an array of float, which need only have the
/// alignment of float.
using LanesInMemory
    [[gnu::vector_size(sizeof(float) * kLaneCount), gnu::aligned(alignof(float)), gnu::may_alias]] = float;

/// Result type of `lanes_at`: a value with Clang, which would lose the reduced alignment behind a reference;
/// a reference to the floats with GCC, which would copy a value of this size through memory.
#ifdef __clang__
using LanesRead = Lanes;
#else
using LanesRead = const LanesInMemory&;
#endif

/// Returns the 16 consecutive floats values[0..15]. `values` needs only the alignment of float. The result
/// may be a reference to the array, see `LanesRead`.
[[gnu::always_inline]] inline LanesRead lanes_at(const float* values) {
    return *reinterpret_cast<const LanesInMemory*>(values);
}

/// SIMD types of `Width` floats, a power of two. A sum that is to stay in a register during many additions
/// must not be wider than a register of the processor, because GCC splits wider values through memory.
template <int Width>
struct Floats {
    /// `Width` floats with element-wise operators and the alignment of the whole vector.
    using Value [[gnu::vector_size(sizeof(float) * Width)]] = float;
    /// `Width` consecutive floats of an array of float, with the alignment of float.
    using InMemory [[gnu::vector_size(sizeof(float) * Width), gnu::aligned(alignof(float)), gnu::may_alias]] =
        float;
};

/// Returns a copy of the `Width` consecutive floats that start at `values`, which needs only the alignment of
/// float.
template <int Width>
[[gnu::always_inline]] inline typename Floats<Width>::Value floats_at(const float* values) {
    return *reinterpret_cast<const typename Floats<Width>::InMemory*>(values);
}

/// Number of floats in a 256-bit register (AVX), the widest of most processors.
inline constexpr int kNarrow = 8;

} // namespace prt

// PRT_TARGET_CLONES and PRT_TWO_CLONES are attributes of a function that is compiled for several vector
// widths; the widest version that the processor supports is selected at run time. A version affects only code
// that is inlined into the function; its helpers are therefore [[gnu::always_inline]]. The attributes are
// empty, and one width is compiled, in each of three cases: the compiler is not GCC for x86-64 Linux, the
// address sanitizer is on (sanitizers cannot instrument the code that selects the version), or
// PRTKIT_NO_CLONES is defined (CMake: PRTKIT_CLONES=OFF).
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) &&                 \
    !defined(__SANITIZE_ADDRESS__) && !defined(PRTKIT_NO_CLONES)
// Three versions: AVX-512, AVX2 and the baseline of the build.
#define PRT_TARGET_CLONES [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
// Two versions: AVX2 and the baseline of the build. For long code that benefits little from AVX-512.
#define PRT_TWO_CLONES [[gnu::target_clones("arch=x86-64-v3", "default")]]
// Attribute of a function that is compiled for AVX-512 only, whose registers have kLaneCount floats. The
// function may be called only if prt::has_wide_registers().
#define PRT_WIDE_TARGET [[gnu::target("arch=x86-64-v4")]]
// Implementation of prt::has_wide_registers().
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

/// Returns whether functions with the attribute PRT_WIDE_TARGET may be called: the processor has AVX-512, and
/// the build compiles several vector widths (PRT_TARGET_CLONES is not empty). If not, the caller uses a
/// function without the attribute.
inline bool has_wide_registers() {
    return PRT_HAS_WIDE_REGISTERS;
}

} // namespace prt
