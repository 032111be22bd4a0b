#include "lang/abi/abi.h"
#include "lang/compile.h"
