// Numbers of the elementary functions. Coefficients are those of least error relative to the function (Remez), the
// lowest power first; where a constant comes in parts, all but the last are short, so that products with them are
// exact.
#pragma once

namespace haptel::ir::elementary {

template <typename Float>
struct Constants;

template <>
struct Constants<double> {
    // sin r = r + r u S(u) and cos r = 1 - u / 2 + u^2 C(u) with u = r^2, |r| <= pi / 4: 2^-57, 2^-62
    static constexpr double sine[] = {-0x1.555555555554dp-3, 0x1.111111110fb50p-7,   -0x1.a01a019c30b50p-13,
                                      0x1.71de356f6f24fp-19, -0x1.ae5e4c548ee98p-26, 0x1.5d8772b4d9cbap-33};
    static constexpr double cosine[] = {0x1.5555555555553p-5,   -0x1.6c16c16c16134p-10, 0x1.a01a019e24eecp-16,
                                        -0x1.27e4f9040ac21p-22, 0x1.1eea895c65350p-29,  -0x1.8ff9dc418ad3ep-37};
    // cosh r = 1 + u / 2 + u^2 E(u) and sinh r = r + r u O(u), |r| <= ln(2) / 2: 2^-69, 2^-60
    static constexpr double even[] = {0x1.555555555555bp-5, 0x1.6c16c16c14080p-10, 0x1.a01a01b19d326p-16,
                                      0x1.27e4c4128deb6p-22, 0x1.1f9768c12fd7cp-29};
    static constexpr double odd[] = {0x1.5555555555558p-3, 0x1.111111110f808p-7, 0x1.a01a01b009bf8p-13,
                                     0x1.71ddf6bacd0bcp-19, 0x1.af631de8e150cp-26};
    // ln((1 + s) / (1 - s)) = 2 s + s z L(z) with z = s^2, |s| <= (sqrt 2 - 1) / (sqrt 2 + 1): 2^-58
    static constexpr double logarithm[] = {0x1.555555555557cp-1, 0x1.99999999847e8p-2, 0x1.2492493fad674p-2,
                                           0x1.c71c52be70e38p-3, 0x1.746647e0c1185p-3, 0x1.399d28e921f6ep-3,
                                           0x1.2f50f877b20fcp-3};
    // the same as 2 s / 3 (3 + z + 3 / 5 z^2 + z^3 T(z)): 2^-71
    static constexpr double logarithm_tail[] = {0x1.b6db6db6dbb6cp-2, 0x1.55555554da6afp-2, 0x1.1745d1d20b593p-2,
                                                0x1.d89d3d9bb8195p-3, 0x1.99ab4694a39b3p-3, 0x1.67134839f4479p-3,
                                                0x1.6d08282c13dcbp-3};
    // atan t = t + t u A(u) with u = t^2, |t| <= 7 / 16: 2^-61
    static constexpr double arc_tangent[] = {-0x1.5555555555554p-2, 0x1.9999999999372p-3,  -0x1.24924924585b0p-3,
                                             0x1.c71c71a7404c2p-4,  -0x1.745d12541c6a3p-4, 0x1.3b1336d25b6f3p-4,
                                             -0x1.110942e603187p-4, 0x1.e134a05c1a500p-5,  -0x1.a9fceed1950ccp-5,
                                             0x1.6b0590a59a846p-5,  -0x1.04fd7985f0539p-5, 0x1.be5f6955e35e6p-7};
    // asin t = t + t u B(u), |t| <= 1 / 2: 2^-59
    static constexpr double arc_sine[] = {
        0x1.5555555555578p-3, 0x1.333333332df7cp-4,  0x1.6db6db7226245p-5, 0x1.f1c71a8dbb151p-6, 0x1.6e8bdfa73fabcp-6,
        0x1.1c49e2ae10367p-6, 0x1.ca20cf32c628cp-7,  0x1.757b719d8c11dp-7, 0x1.61741e3bc012ep-7, 0x1.e2bc4f55abddap-9,
        0x1.64934b0768ab6p-6, -0x1.595547ba38ebcp-6, 0x1.0bb09a47a4efdp-5};

    static constexpr double quarter_turn[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69,
                                              0x1.b839a252049c1p-104};
    static constexpr double ln2[] = {0x1.62e42fefa38p-1, 0x1.ef35793c76730p-45};      // times a whole number to 2^11
    static constexpr double ln2_halves[] = {0x1.62e42f8p-1, 0x1.be8e7bcd5e4f2p-27};   // times half a significand
    static constexpr double log2e_halves[] = {0x1.7154760p+0, 0x1.4ae0bf85ddf44p-26}; // 1 / ln 2
    static constexpr double pi[] = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
    static constexpr double half_pi[] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
    static constexpr double quarter_pi[] = {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55};
    static constexpr double atan_of_half[] = {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56};
    static constexpr double half_turns_of_half[] = {0x1.2e4051d9df308p-3, 0x1.995a23db6b8d4p-57}; // atan(1 / 2) / pi
    static constexpr double inverse_pi[] = {0x1.45f3068p-2, 0x1.727220a94fe14p-28};

    // Beyond these the result is infinite or 0, or the function is the identity
    static constexpr double exp_range[] = {-746, 710}, exp2_range[] = {-1076, 1025};
    static constexpr double sinh_limit = 711, tanh_limit = 22, identity_below = 0x1p-29;
};

template <>
struct Constants<float> {
    static constexpr double sine[] = {-0x1.555546p-3, 0x1.1106bap-7, -0x1.99071ap-13};   // 2^-27
    static constexpr double cosine[] = {0x1.55554ep-5, -0x1.6c0e78p-10, 0x1.9a6f60p-16}; // 2^-31
    static constexpr double even[] = {0x1.555470p-5, 0x1.6da758p-10};                    // 2^-33
    static constexpr double odd[] = {0x1.555494p-3, 0x1.123d88p-7};                      // 2^-25
    static constexpr double logarithm[] = {0x1.55557ap-1, 0x1.995ae6p-2, 0x1.326fcap-2}; // 2^-29
    static constexpr double arc_tangent[] = {-0x1.555546p-2, 0x1.998e34p-3, -0x1.2367f8p-3, 0x1.ad19cap-4,
                                             -0x1.d8c680p-5}; // 2^-28
    static constexpr double arc_sine[] = {0x1.5555cap-3, 0x1.33014ep-4, 0x1.748c68p-5, 0x1.8ba230p-6,
                                          0x1.59daecp-5}; // 2^-27

    // For powers, in f64: 2^-33, 2^-36, 2^-44
    static constexpr double even_f64[] = {0x1.000000456844ep-1, 0x1.555470a66ed8cp-5, 0x1.6da75794ca8b5p-10};
    static constexpr double odd_f64[] = {0x1.555555742a82ep-3, 0x1.1110ab79a039bp-7, 0x1.a17df63788647p-13};
    static constexpr double logarithm_f64[] = {0x1.55555555f325fp-1, 0x1.999996d2a7ff3p-2, 0x1.24941523da557p-2,
                                               0x1.c62567003a6d3p-3, 0x1.91971d15500d4p-3};

    static constexpr double ln2[] = {0x1.62e4p-1, 0x1.7f7d1cp-20};
    static constexpr double ln2_halves[] = {0x1.62ep-1, 0x1.0bfbe8p-15};
    static constexpr double log2e_halves[] = {0x1.714p+0, 0x1.47652cp-12};
    static constexpr double pi[] = {0x1.921fb6p+1, -0x1.777a5cp-24};
    static constexpr double half_pi[] = {0x1.921fb6p+0, -0x1.777a5cp-25};
    static constexpr double quarter_pi[] = {0x1.921fb6p-1, -0x1.777a5cp-26};
    static constexpr double atan_of_half[] = {0x1.dac670p-2, 0x1.586ed4p-28};
    static constexpr double half_turns_of_half[] = {0x1.2e4052p-3, -0x1.31067cp-30};
    static constexpr double inverse_pi[] = {0x1.45ep-2, 0x1.306dcap-14};

    static constexpr double exp_range[] = {-104, 89}, exp2_range[] = {-151, 129};
    static constexpr double sinh_limit = 90, tanh_limit = 10, identity_below = 0x1p-13;
};

inline constexpr double log2e = 0x1.71547652b82fep+0, two_over_pi = 0x1.45f306dc9c883p-1;

} // namespace haptel::ir::elementary

namespace haptel::ir::turn {

// Sine and cosine of an eighth of a turn, which every engine computes by Horner's rule, each multiplication and
// addition rounded, so that the bits are the same: for 0 <= m <= 1/8 turns and u = m m, sin(2 pi m) = m (s0 + s1 u +
// ...) and cos(2 pi m) = 1 + u (c0 + c1 u + ...). Errors before rounding: 3.4e-18 and 4.1e-19 of the values in
// f64, 3.3e-9 and 6.4e-10 in f32.
inline constexpr double sine_f64[] = {0x1.921fb54442d18p+2,  -0x1.4abbce625be41p+5, 0x1.466bc67758700p+6,
                                      -0x1.32d2cce2d535dp+6, 0x1.50782fca388fcp+5,  -0x1.e30063a00c5e9p+3,
                                      0x1.e3eed5c67a376p+1};
inline constexpr double cosine_f64[] = {-0x1.3bd3cc9be45dep+4, 0x1.03c1f081b5ac0p+6,  -0x1.55d3c7e3cb212p+6,
                                        0x1.e1f506868296fp+5,  -0x1.a6d1eeee7661ap+4, 0x1.f9ce1f05fdd6fp+2,
                                        -0x1.b2f223e753226p+0};
inline constexpr double sine_f32[] = {0x1.921fb52e6a187p+2, -0x1.4abbb9003a25dp+5, 0x1.465e91ee4a6cep+6,
                                      -0x1.2d9302266689ep+6};
inline constexpr double cosine_f32[] = {-0x1.3bd3cc988abacp+4, 0x1.03c1e9dfb66bdp+6, -0x1.55cb88bcbe886p+6,
                                        0x1.db5fa8dfa954bp+5};

} // namespace haptel::ir::turn
