#include "runtime/scene.h"
