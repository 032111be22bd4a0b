#include "tests/support/allocated.h"

#include <cstdlib>
#include <new>

namespace {

thread_local uint64_t allocated = 0;

} // namespace

uint64_t haptel::test::allocated_bytes() noexcept
{
    return allocated;
}

// The other forms of new and delete end in these.
void* operator new(std::size_t size)
{
    allocated += size;
    if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
    throw std::bad_alloc();
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}
