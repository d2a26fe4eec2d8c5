/// How much work a test does where each step takes ten times as long.
#pragma once

namespace alhazen::testing_support {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif
#else
inline constexpr bool is_sanitized = false;
#endif

/// A number of samples, for tests whose bounds follow from it: a quarter of n in sanitized programs, which
/// are to run all the text, not to measure.
constexpr int fewer_if_sanitized(int n) {
    return is_sanitized ? n / 4 : n;
}

} // namespace alhazen::testing_support
