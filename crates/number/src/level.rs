//! Which SIMD levels code is compiled for.

/// Runs `$body` with the SIMD token `$s` of `$level`, as `fearless_simd::dispatch!` does, but on x86 only for AVX2 and the
/// baseline: AVX-512 was hardly faster than AVX2 where it was measured, no machine that is still sold needs the levels between,
/// and each level takes as long to compile again.
#[macro_export]
macro_rules! at_level {
    ($level:expr, $s:ident => $body:expr) => {{
        let level: fearless_simd::Level = $level;
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if let Some($s) = level.as_avx2() {
            fearless_simd::Simd::vectorize($s, #[inline(always)] || $body)
        } else if let Some($s) = level.as_sse2() {
            fearless_simd::Simd::vectorize($s, #[inline(always)] || $body)
        } else {
            unreachable!("every x86 processor that this is compiled for has SSE2")
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        {
            fearless_simd::dispatch!(level, $s => $body)
        }
    }};
}
