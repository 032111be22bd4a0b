#include "libraries/lock.h"
#include "tests/support/catch.h"

using namespace haptel;
using namespace haptel::libraries;

TEST_CASE("haptel.lock: what is written is read, in one order")
{
    const std::string a(64, 'a'), b(64, 'b');
    const std::string text = lock_text({{"wood", {2, 0, 0}, b}, {"stone", {1, 0, 0}, b}, {"wood", {1, 2, 3}, a}});
    CHECK(text == lock_text({{"wood", {1, 2, 3}, a}, {"wood", {2, 0, 0}, b}, {"stone", {1, 0, 0}, b}}));
    input::FileMessages messages("haptel.lock");
    const auto read = read_lock(text, messages);
    CHECK(messages.text() == "");
    REQUIRE(read);
    REQUIRE(read->size() == 3);
    CHECK((*read)[0].name == "stone");
    CHECK((*read)[1].version == Version{1, 2, 3});
    CHECK((*read)[1].sha256 == a);
    CHECK((*read)[2].version == Version{2, 0, 0});
    CHECK(read_lock("", messages)->empty());
}

TEST_CASE("haptel.lock: what is none is told")
{
    for (const char* const text :
         {"[library]\n", "library = 1\n", "[[library]]\n",
          "[[library]]\nname = \"wood\"\nversion = \"1\"\nsha256 = \"\"\n",
          "[[library]]\nname = \"wood\"\nversion = \"1.0.0\"\nsha256 = \"AA\"\n", "[[librarie]]\n", "[["}) {
        input::FileMessages messages("haptel.lock");
        CHECK(!read_lock(text, messages));
        INFO(messages.text());
        CHECK(messages.text().starts_with("haptel.lock:"));
    }
}
