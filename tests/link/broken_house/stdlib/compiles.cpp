#include "lang/compile.h"
