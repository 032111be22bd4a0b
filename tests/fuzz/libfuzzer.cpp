// The same targets for clang's libFuzzer, one program each: HAPTEL_FUZZ_TARGET says which.
#include "tests/fuzz/target.h"

#include <cstddef>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    for (const haptel::fuzz::Target& target : haptel::fuzz::targets())
        if (target.name == HAPTEL_FUZZ_TARGET) target.run({reinterpret_cast<const char*>(data), size});
    return 0;
}
