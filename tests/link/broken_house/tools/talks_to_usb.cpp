#include <libusb-1.0/libusb.h>
#include "runtime/scene/scene.h"
#include "jit/compile_texture.h"
