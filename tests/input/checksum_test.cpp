#include "input/checksum.h"

#include "tests/support/catch.h"

#include <random>
#include <set>
#include <string>

using namespace haptel::input;

TEST_CASE("strings that differ in a bit, a length or where one ends have different checksums")
{
    std::mt19937 random(1);
    std::set<std::string> seen;
    std::size_t strings = 0;
    const auto add = [&](const Checksum& sum) {
        seen.insert(to_text(sum));
        ++strings;
    };
    for (std::size_t length = 0; length <= 200; ++length) {
        std::string bytes(length, '\0');
        add(checksum(bytes)); // zeros of each length
        for (char& byte : bytes) byte = static_cast<char>(random());
        if (length > 0) add(checksum(bytes));
        for (std::size_t bit = 0; bit < 8 * length; ++bit) {
            std::string changed = bytes;
            changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ 1 << bit % 8);
            add(checksum(changed));
        }
    }
    for (const std::size_t cut : {0u, 1u, 3u, 6u})
        add(checksum(std::string("abcdef").substr(cut), checksum(std::string("abcdef").substr(0, cut))));
    CHECK(seen.size() == strings);
    CHECK(checksum("ab") == checksum("ab"));
    CHECK(to_text(Checksum{1, 2}) == "00000000000000020000000000000001");
}

TEST_CASE("each bit of a checksum changes for about half of the bits of what it is of")
{
    std::mt19937 random(2);
    std::string bytes(96, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    const Checksum before = checksum(bytes);
    int changed[128] = {};
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        std::string other = bytes;
        other[bit / 8] = static_cast<char>(other[bit / 8] ^ 1 << bit % 8);
        const Checksum after = checksum(other);
        for (int k = 0; k < 64; ++k) {
            changed[k] += int((before.low ^ after.low) >> k & 1);
            changed[64 + k] += int((before.high ^ after.high) >> k & 1);
        }
    }
    for (const int times : changed) CHECK(std::abs(times - 384) < 84); // six times the square root of 768 / 4
}
