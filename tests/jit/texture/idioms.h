// Textures as authors of shaders write them, whose heights interval arithmetic proves too wide or not at all.
#pragma once

namespace haptel::test {

inline constexpr const char* idioms = R"(
vec3 wrapped(vec3 x) { return x - floor(x * (1.0 / 289.0)) * 289.0; }
vec3 shuffled(vec3 x) { return wrapped((x * 34.0 + 1.0) * x); }

/// Simplex noise in the plane, its corners' gradients from a polynomial of their numbers.
float simplex_plane(vec2 v)
{
    float skew = 0.366025403784439, back = 0.211324865405187;
    vec2 i = floor(v + (v.x + v.y) * skew);
    vec2 x0 = v - i + (i.x + i.y) * back;
    vec2 second = x0.x > x0.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec2 x1 = x0 - second + back;
    vec2 x2 = x0 - 1.0 + 2.0 * back;
    vec3 p = shuffled(shuffled(wrapped(i.y + vec3(0.0, second.y, 1.0))) + wrapped(i.x + vec3(0.0, second.x, 1.0)));
    vec3 m = max(0.5 - vec3(dot(x0, x0), dot(x1, x1), dot(x2, x2)), 0.0);
    m = m * m * m * m;
    vec3 x = 2.0 * fract(p * (1.0 / 41.0)) - 1.0;
    vec3 h = abs(x) - 0.5;
    vec3 a = x - floor(x + 0.5);
    vec3 long2 = a * a + h * h;
    vec3 g = vec3(a.x * x0.x + h.x * x0.y, a.y * x1.x + h.y * x1.y, a.z * x2.x + h.z * x2.y);
    return 130.0 * dot(m * (1.79284291400159 - 0.85373472095314 * long2), g);
}
texture simplex() { return 50um * simplex_plane(p.xy / 3mm); }
/// Its denominator is a square, written out.
texture folded()
{
    vec3 q = p / 2mm;
    return 40um / (1.0 + q.x * q.x - 2.0 * q.x * sin(q.y) + sin(q.y) * sin(q.y));
}
/// Differences of what is equal but for little.
texture cancelled() { float a = p.x / 1mm; return 30um * (pow(a + sin(a), 2.0) - a * a - 2.0 * a * sin(a)); }
/// By the direction of the surface alone.
texture directed() { return 60um * (8.0 * (n.x * n.x * n.y - n.y * n.x * n.x) + n.z * (1.0 - n.x * n.x - n.y * n.y)); }
/// By the mesh's coordinates alone.
texture unrolled() { vec2 q = 7.0 * uv; return 20um * (q.x * q.x - q.x * q.x + simplex_plane(q)); }
)";

} // namespace haptel::test
