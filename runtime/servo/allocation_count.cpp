#include "runtime/servo/allocation_count.h"

#include <cerrno>
#include <cstddef>

namespace {

// Plain and constant-initialised, so that reading it needs no guard; part of the program itself, so that reaching it
// allocates nothing.
thread_local uint64_t allocations = 0;
thread_local uint64_t bytes = 0;

void count(std::size_t size) noexcept
{
    ++allocations;
    bytes += size;
}

} // namespace

namespace haptel::runtime {

uint64_t allocations_of_this_thread() noexcept
{
    return allocations;
}

uint64_t allocated_bytes_of_this_thread() noexcept
{
    return bytes;
}

} // namespace haptel::runtime

#if defined(__has_feature)
#define HAPTEL_HAS_FEATURE(name) __has_feature(name)
#else
#define HAPTEL_HAS_FEATURE(name) 0
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || HAPTEL_HAS_FEATURE(address_sanitizer) ||          \
    HAPTEL_HAS_FEATURE(thread_sanitizer) || HAPTEL_HAS_FEATURE(memory_sanitizer)

// The sanitizer calls these weak hooks around every allocation.
extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t size)
{
    count(size);
}
extern "C" void __sanitizer_free_hook(const volatile void*) {}

#elif defined(__GLIBC__)

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): glibc's own names
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size)
{
    count(size);
    return __libc_malloc(size);
}

void* calloc(std::size_t elements, std::size_t size)
{
    count(elements * size);
    return __libc_calloc(elements, size);
}

void* realloc(void* old, std::size_t size)
{
    count(size);
    return __libc_realloc(old, size);
}

void* memalign(std::size_t alignment, std::size_t size)
{
    count(size);
    return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size)
{
    return memalign(alignment, size);
}

int posix_memalign(void** result, std::size_t alignment, std::size_t size)
{
    if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
    void* memory = memalign(alignment, size);
    if (!memory) return ENOMEM;
    *result = memory;
    return 0;
}

void free(void* memory)
{
    __libc_free(memory);
}

} // extern "C"

#else
#error "counting allocations is written for glibc and for sanitizers only"
#endif
