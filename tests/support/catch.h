// Catch2 of either generation. Compare numbers with an explicit bound, never with Approx: the bound is the claim.
#pragma once
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
#else
#include <catch2/catch.hpp>
#endif
