// Whether a sanitizer looks on.

#ifndef TRAVERSE_TESTS_SUPPORT_SANITIZERS_H_
#define TRAVERSE_TESTS_SUPPORT_SANITIZERS_H_

namespace traverse::testing {

// Sanitizers slow everything down several times.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_SANITIZERS_H_
