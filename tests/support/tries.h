// How often tests with random input try.
#pragma once

namespace haptel::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

// `count` tries, or what is expected to be seen in them: a tenth where the program is sanitized, which is some five
// times slower and finds what it finds early.
constexpr auto tries(auto count)
{
    return is_sanitized ? count / 10 : count;
}

} // namespace haptel::test
