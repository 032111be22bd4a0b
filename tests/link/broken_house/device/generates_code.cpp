#include "jit/compile_texture.h"
#include "runtime/hand/haptic_device.h"
