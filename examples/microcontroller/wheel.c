/* The whole loop of a haptic wheel: angle in, texture, torque out. It allocates nothing and waits for nothing, and its
 * longest time is known: the comment on top of detents.c tells the operations of a call.
 *
 * A finger that rests on ridges with `press_n` is pushed back by press_n times their slope.
 */
#include <wheel.h>

#include <board.h>
#include <detents.h>

static const float radius_m = 0.03F, press_n = 2.0F, torque_limit_n_m = 0.03F;

static haptel_block_detents block;

void wheel_start(void)
{
    block = haptel_defaults_detents;
    block.depth = 0.5e-3;
    board_set_torque_n_m(0.0F);
}

void wheel_tick(void)
{
    static haptel_point point; /* all that is not set is 0 */
    haptel_sample sample;
    float torque;
    point.p[0] = (double)(radius_m * board_angle_rad());
    haptel_texture_detents.height_gradient(&point, &block, &sample);
    torque = -press_n * (float)sample.gradient[0] * radius_m;
    if (torque > torque_limit_n_m) torque = torque_limit_n_m;
    if (torque < -torque_limit_n_m) torque = -torque_limit_n_m;
    board_set_torque_n_m(sample.faults ? 0.0F : torque);
}
