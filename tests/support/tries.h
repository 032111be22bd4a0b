// How often tests with random input try.
#pragma once

namespace haptel::test {

// `count` tries, or what is expected to be seen in them: a fifth where the program is sanitized, which is some five
// times slower and finds what it finds early.
constexpr auto tries(auto count)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return count / 5;
#else
    return count;
#endif
}

} // namespace haptel::test
