/* A texture that was compiled when this program was built: C, the C library, and nothing of Haptel at run time.
 *
 * CMakeLists.txt beside it builds it with haptel_add_textures().
 */
#include <rock.h>

#include <stdio.h>
#include <string.h>

/* What a program finds out that does not know the texture's header, such as one that draws sliders. */
static void describe(const haptel_texture* texture)
{
    uint32_t i;
    printf("%s: %.0f um to %.0f um high, at most %u operations\n", texture->name, 1e6 * texture->facts.height_min_m,
           1e6 * texture->facts.height_max_m, (unsigned)texture->facts.operations_max);
    for (i = 0; i < texture->parameter_count; ++i) {
        const haptel_parameter* parameter = &texture->parameters[i];
        printf("  %s = %g %s, from %g to %g\n", parameter->name, parameter->value, parameter->unit, parameter->minimum,
               parameter->maximum);
    }
}

int main(void)
{
    haptel_block_rock block = haptel_defaults_rock;
    haptel_point point;
    haptel_sample sample;
    int i;
    if (haptel_texture_rock.abi != HAPTEL_ABI_VERSION) return 1;
    describe(&haptel_texture_rock);
    block.octaves = 3;
    memset(&point, 0, sizeof point);
    for (i = 0; i < 5; ++i) {
        point.p[0] = 1e-3 * i;
        haptel_texture_rock.height_gradient(&point, &block, &sample);
        printf("at %d mm: height %7.2f um, slope %7.4f along x\n", i, 1e6 * sample.height_m, sample.gradient[0]);
        if (sample.faults) return 1;
    }
    return 0;
}
