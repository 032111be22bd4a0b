// What a helper of C text is before it is one of doubles or of floats.
#pragma once

namespace haptel::emit_c {

// In the text `real` is double or float, $ the ending of that type's functions in <math.h>, and what is in capitals one
// of the numbers in helpers.cpp. A table of them has callees first.
struct HelperText {
    const char *name, *text;
};

} // namespace haptel::emit_c
