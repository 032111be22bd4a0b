// What the shared libraries show of themselves.
#pragma once

#define HAPTEL_API __attribute__((visibility("default")))
