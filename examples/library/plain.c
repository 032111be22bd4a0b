/* In C: a texture with its exact gradient, and a ball that a simulated hand feels twice the same. */
#include <haptel/c.h>

#include <stdio.h>

static const char text[] = "/// Rings round the origin.\n"
                           "texture ripple(float wavelength = 4mm in 1mm .. 20mm, float depth = 50um in 0um .. 200um)\n"
                           "{ return depth * sinturn(length(p.xy) / wavelength); }\n";

static int look_at_a_texture(void)
{
    const haptel_value values[] = {{"depth", "80um"}};
    haptel_compiled* const ripple = haptel_compile(text, "ripple", values, 1);
    const double points_m[] = {3.1e-3, 4.2e-3, 0, 0, 1e-3, 0};
    double heights_m[2], gradients[6];
    if (!haptel_evaluate(ripple, points_m, 2, heights_m, gradients)) {
        fputs(haptel_compiled_messages(ripple), stderr);
        haptel_compiled_free(ripple);
        return 0;
    }
    printf("ripple: %.2f um at 3.1 mm, 4.2 mm, with slopes %.4f and %.4f; never above %.2f um\n", 1e6 * heights_m[0],
           gradients[0], gradients[1], 1e6 * haptel_compiled_facts(ripple).height_max_m);
    haptel_compiled_free(ripple);
    return 1;
}

static int feel_a_ball(const char* texture)
{
    haptel_source* const textures = haptel_compiler(0);
    haptel_builder* const builder = haptel_builder_new(textures);
    const uint32_t ball = haptel_add_shape(builder, "icosphere", 0.1, NULL);
    haptel_scene* scene;
    haptel_servo* servo;
    int well;
    haptel_object_texture(builder, ball, texture, NULL, 0);
    scene = haptel_build(builder, NULL);
    servo = haptel_servo_new(scene, "simulated:premium", 1, 1);
    well = haptel_servo_ok(servo);
    fputs(haptel_scene_messages(scene), stderr);
    if (well) {
        haptel_report report;
        haptel_servo_start(servo);
        report = haptel_servo_wait(servo);
        printf("ball: %lu ticks, %lu in contact, at most %.2f N\n", (unsigned long)report.ticks,
               (unsigned long)report.contact_ticks, report.force_max_n);
        well = !report.faulted && report.ticks == 1000 && report.contact_ticks > 100;
    } else {
        fputs(haptel_servo_messages(servo), stderr);
    }
    haptel_servo_free(servo);
    haptel_scene_free(scene);
    haptel_builder_free(builder);
    haptel_source_free(textures);
    return well;
}

int main(int count, char** arguments)
{
    return look_at_a_texture() && (count < 2 || feel_a_ball(arguments[1])) ? 0 : 1;
}
