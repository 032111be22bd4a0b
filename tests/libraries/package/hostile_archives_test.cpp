#include "tests/libraries/package/hostile_archives.h"

#include "libraries/package/archive.h"
#include "tests/libraries/library_text.h"
#include "tests/support/catch.h"

using namespace haptel;
using namespace haptel::libraries;
using namespace haptel::test;

TEST_CASE("an archive that is made byte by byte is read, so that the others are refused for what is wrong with them")
{
    const PackageResult read = read_archive(sound_archive(), "wood.haptlib");
    CHECK(read.messages == "");
    REQUIRE(read.package);
    CHECK(read.package->contents == library("wood", "1.0.0").contents);
}

TEST_CASE("hostile archives are refused, and it is told why")
{
    const std::vector<HostileArchive> archives = hostile_archives();
    CHECK(archives.size() >= 60);
    for (const HostileArchive& archive : archives) {
        INFO(archive.what);
        const PackageResult read = read_archive(archive.bytes, "evil.haptlib");
        INFO(read.messages);
        CHECK(!read.package);
        CHECK(read.messages.starts_with("evil.haptlib"));
        CHECK(read.messages.find(": error: ") != std::string::npos);
        CHECK(read.messages.find(archive.said) != std::string::npos);
        CHECK(read.messages.find('\x1b') == std::string::npos); // nothing that a terminal obeys
    }
}

TEST_CASE("an archive cut anywhere, or with a bit changed anywhere, is refused or is the same library")
{
    const std::string whole = sound_archive();
    const Contents contents = library("wood", "1.0.0").contents;
    for (size_t size = 0; size < whole.size(); ++size) CHECK(!read_archive(whole.substr(0, size), "x").package);
    for (size_t at = 0; at < whole.size(); ++at)
        for (int bit = 0; bit < 8; bit += 3) {
            std::string bytes = whole;
            bytes[at] = static_cast<char>(bytes[at] ^ 1 << bit);
            const PackageResult read = read_archive(bytes, "x");
            if (read.package) CHECK(read.package->contents == contents); // a date, say
        }
}
