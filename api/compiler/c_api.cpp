#include "api/c_source.h"

#include <haptel/c.h>
#include <haptel/compiler.h>

#include <algorithm>
#include <array>
#include <exception>
#include <span>

struct haptel_compiled {
    haptel::Texture texture;
};

haptel_source* haptel_compiler(int32_t follow_files)
{
    try {
        return new haptel_source{haptel::compiler({.follow_files = follow_files != 0})};
    } catch (const std::exception&) { // no memory
        return nullptr;
    }
}

haptel_compiled* haptel_compile(const char* text, const char* name, const haptel_value* values, size_t count)
{
    try {
        return new haptel_compiled{
            haptel::compile(text ? text : "", name ? name : "", haptel::parameters_of(values, count))};
    } catch (const std::exception&) { // no memory
        return nullptr;
    }
}

int32_t haptel_compiled_ok(const haptel_compiled* compiled)
{
    return compiled && compiled->texture;
}

const char* haptel_compiled_messages(const haptel_compiled* compiled)
{
    return compiled ? compiled->texture.messages().c_str() : "error: there is no memory for it\n";
}

const haptel_texture* haptel_compiled_table(const haptel_compiled* compiled)
{
    return haptel_compiled_ok(compiled) ? &compiled->texture.table() : nullptr;
}

haptel_facts haptel_compiled_facts(const haptel_compiled* compiled)
{
    return haptel_compiled_ok(compiled) ? compiled->texture.facts() : haptel_facts{};
}

int32_t haptel_evaluate(const haptel_compiled* compiled, const double* points_m, size_t count, double* heights_m,
                        double* gradients)
{
    if (!haptel_compiled_ok(compiled)) return 0;
    constexpr size_t at_once = 256;
    std::array<haptel::Vec3, at_once> points_of_some, gradients_of_some;
    for (size_t first = 0; first < count; first += at_once) {
        const size_t some = std::min(at_once, count - first);
        for (size_t i = 0; i < some; ++i) {
            const double* p = points_m + 3 * (first + i);
            points_of_some[i] = {p[0], p[1], p[2]};
        }
        compiled->texture.evaluate(std::span(points_of_some).first(some), {heights_m + first, some},
                                   std::span(gradients_of_some).first(gradients ? some : 0));
        for (size_t i = 0; gradients && i < some; ++i) {
            const haptel::Vec3& g = gradients_of_some[i];
            double* const to = gradients + 3 * (first + i);
            to[0] = g.x, to[1] = g.y, to[2] = g.z;
        }
    }
    return 1;
}

void haptel_compiled_free(haptel_compiled* compiled)
{
    delete compiled;
}
