// Must not compile: the code is in no table. Only a message that says so is a pass.
#include "lang/text/diagnostic.h"

void report(haptel::lang::Diagnostics& diagnostics)
{
    diagnostics.error({}, "unknown-nmae", "a code with a slip of the pen");
}
