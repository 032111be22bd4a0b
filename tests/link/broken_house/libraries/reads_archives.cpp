#include "jit/texture/texture.h"
#include "libraries/package/archive.h"
#include <zip.h>
