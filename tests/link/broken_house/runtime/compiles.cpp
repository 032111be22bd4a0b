#include "lang/abi.h"
#include "lang/compile.h"
