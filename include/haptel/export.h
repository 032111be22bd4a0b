/* What the shared libraries show of themselves. */
#ifndef HAPTEL_EXPORT_H
#define HAPTEL_EXPORT_H

#define HAPTEL_API __attribute__((visibility("default")))

#endif
