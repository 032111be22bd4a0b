/* A wheel of numbers in place of a board: a hand turns it for half a second and lets go. It must come to rest in a
 * valley between two ridges, or the program fails. */
#include <board.h>
#include <wheel.h>

#include <math.h>
#include <stdio.h>

static double angle_rad, speed_rad_per_s, motor_n_m, most_n_m;

float board_angle_rad(void)
{
    return (float)angle_rad;
}

void board_set_torque_n_m(float torque)
{
    motor_n_m = torque;
    most_n_m = fmax(most_n_m, fabs(motor_n_m));
}

int main(void)
{
    const double period_s = 1e-3, inertia_kg_m2 = 2e-5, damping_n_m_s = 1e-3, hand_n_m = 0.02;
    const double radius_m = 0.03, pitch_m = 5e-3;
    double from_valley_m;
    int tick;
    wheel_start();
    for (tick = 0; tick < 2000; ++tick) {
        double torque;
        wheel_tick();
        torque = motor_n_m - damping_n_m_s * speed_rad_per_s + (tick < 500 ? hand_n_m : 0.0);
        speed_rad_per_s += torque / inertia_kg_m2 * period_s;
        angle_rad += speed_rad_per_s * period_s;
    }
    from_valley_m = remainder(radius_m * angle_rad - pitch_m / 2, pitch_m);
    printf("%d ticks: at rest after %.1f turns, %.3f mm from a valley, torque at most %.4f N m\n", tick,
           angle_rad / 6.283185307179586, 1e3 * from_valley_m, most_n_m);
    return angle_rad > 6.0 && fabs(from_valley_m) < 1e-4 && fabs(speed_rad_per_s) < 1e-2 && most_n_m > 0.01 ? 0 : 1;
}
