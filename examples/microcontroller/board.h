/* What the wheel needs of its board. On a microcontroller these are a few lines over its registers; simulated_board.c
 * has a wheel made of numbers. */
#ifndef BOARD_H
#define BOARD_H

float board_angle_rad(void);             /* of the encoder on the shaft */
void board_set_torque_n_m(float torque); /* of the motor on it */

#endif
