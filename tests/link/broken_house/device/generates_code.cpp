#include "jit/compile_texture.h"
#include "runtime/haptic_device.h"
