// Sine and cosine of an eighth of a turn, as polynomials: what every engine computes, so that their bits are the same.
//
// For 0 <= m <= 1/8 turns and u = m m: sin(2 pi m) = m (s0 + s1 u + s2 u^2 + ...) and cos(2 pi m) = 1 + u (c0 + c1 u +
// ...), by Horner's rule, each multiplication and addition rounded. The coefficients are those of least relative error
// (Remez); before rounding that is 3.4e-18 and 4.1e-19 of the values in f64, 3.3e-9 and 6.4e-10 in f32.
#pragma once

namespace haptel::ir::turn {

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
