// The C interface: the forces of a spring, values that change, and nulls, of which nothing comes.
#include "tests/api/scenes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <haptel/c.h>
#include <string>

using haptel::test::contains;

TEST_CASE("c: a mesh of a program's own is a spring where it was put, and late ticks are counted")
{
    haptel_builder* const builder = haptel_builder_new(nullptr);
    haptel_material material = haptel_default_material();
    material.stiffness_n_per_m = 500;
    material.damping_n_s_per_m = material.static_friction = material.dynamic_friction = 0;
    const double positions_m[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    const uint32_t triangles[] = {0, 1, 2};
    const uint32_t object = haptel_add_mesh(builder, positions_m, 3, triangles, 1, &material);
    CHECK(object == 1);
    const double place_m[] = {0, 0, 0.5};
    CHECK(haptel_object_place(builder, object, place_m, nullptr) == 1);
    CHECK(haptel_object_place(builder, 2, place_m, nullptr) == 0);
    CHECK(haptel_object_apart(builder, object) == 1);
    CHECK(haptel_add_shape(builder, "dodecahedron", 1, nullptr) == 0);
    haptel_scene_settings settings = haptel_default_settings();
    settings.force_rise_s = 0.1;
    haptel_scene* const scene = haptel_build(builder, &settings);
    REQUIRE(haptel_scene_ok(scene));
    haptel_renderer* const renderer = haptel_renderer_new(scene);
    haptel_scene_free(scene); // the renderer keeps what it needs
    const double above_m[] = {0, 0, 0.501}, below_m[] = {0, 0, 0.498};
    haptel_tick(renderer, above_m, nullptr, 1);
    const double early_n = haptel_tick(renderer, below_m, nullptr, 1).force_n[2];
    CHECK(early_n < 0.2); // it rises over 100 ticks
    const double late_n = haptel_tick(renderer, below_m, nullptr, 200).force_n[2];
    CHECK(std::fabs(late_n - 500 * 2e-3) < 1e-6);
    haptel_between_ticks(renderer);
    haptel_renderer_free(renderer);
    haptel_builder_free(builder);
}

TEST_CASE("c: what is refused says why, and nulls are refused in turn")
{
    haptel_builder* const builder = haptel_builder_new(nullptr);
    haptel_scene* const scene = haptel_build(builder, nullptr);
    CHECK(!haptel_scene_ok(scene));
    CHECK(contains(haptel_scene_messages(scene), "a scene needs something to touch"));
    CHECK(contains(haptel_scene_set(scene, 1, "depth", "1um"), "the scene has no object 1"));
    haptel_servo* const servo = haptel_servo_new(scene, nullptr, 1, 1);
    CHECK(!haptel_servo_ok(servo));
    haptel_servo_start(servo);
    CHECK(haptel_servo_wait(servo).faulted == 1);
    CHECK(contains(haptel_servo_stop_reason(servo), "a scene needs something to touch"));
    haptel_servo_free(servo);
    haptel_scene_free(scene);
    haptel_builder_free(builder);

    haptel_compiled* const broken = haptel_compile("texture t() { return dept; }", nullptr, nullptr, 0);
    CHECK(!haptel_compiled_ok(broken));
    CHECK(contains(haptel_compiled_messages(broken), "error: "));
    CHECK(haptel_compiled_table(broken) == nullptr);
    CHECK(haptel_evaluate(broken, nullptr, 0, nullptr, nullptr) == 0);
    haptel_compiled_free(broken);

    CHECK(haptel_add_shape(nullptr, "box", 1, nullptr) == 0);
    CHECK(haptel_add_mesh(nullptr, nullptr, 0, nullptr, 0, nullptr) == 0);
    CHECK(haptel_add_file(nullptr, nullptr, 0, nullptr) == 0);
    CHECK(haptel_object_texture(nullptr, 1, nullptr, nullptr, 0) == 0);
    CHECK(haptel_build(nullptr, nullptr) == nullptr);
    CHECK(!haptel_scene_ok(nullptr));
    CHECK(contains(haptel_scene_messages(nullptr), "memory"));
    CHECK(haptel_servo_new(nullptr, nullptr, 0, 0) == nullptr);
    CHECK(haptel_servo_wait(nullptr).ticks == 0);
    CHECK(haptel_renderer_new(nullptr) == nullptr);
    CHECK(haptel_tick(nullptr, nullptr, nullptr, 1).contacts == 0);
    CHECK(haptel_compiled_facts(nullptr).slope_max == 0);
    haptel_source_free(haptel_precompiled(nullptr, 3));
    haptel_servo_start(nullptr);
    haptel_servo_request_stop(nullptr);
    haptel_between_ticks(nullptr);
    haptel_source_free(nullptr);
    haptel_scene_free(nullptr);
}
