#include "runtime/scene/scene.h"
