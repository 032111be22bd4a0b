/* A wheel with a texture on its rim. */
#ifndef WHEEL_H
#define WHEEL_H

void wheel_start(void);
void wheel_tick(void); /* once each millisecond, such as from a timer's interrupt */

#endif
