#include "libraries/sha256.h"

#include <cstdint>
#include <sys/types.h> // which sha2.h needs and does not include

#include <sha2.h>

namespace haptel::libraries {

std::string sha256(std::string_view bytes)
{
    char digits[SHA256_DIGEST_STRING_LENGTH] = "";
    SHA256Data(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), digits);
    return digits;
}

} // namespace haptel::libraries
