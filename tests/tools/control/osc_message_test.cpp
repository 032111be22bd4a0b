// OSC messages between bytes and values, held to bytes that are put together by hand.
#include "tests/support/catch.h"
#include "tests/tools/control/osc_bytes.h"
#include "tools/control/osc_message.h"

using namespace haptel;
using namespace haptel::test;
using tools::OscValue;

namespace {

std::string error_of(const std::string& bytes)
{
    return tools::read_osc(bytes).error;
}

} // namespace

TEST_CASE("osc: each kind of value is read as it was written")
{
    const std::string values = osc_word(0xfffffffe) + osc_float(0.25f) + osc_text("60um") + osc_word(1) + osc_word(2) +
                               osc_word(0x3fe00000) + osc_word(0);
    const tools::OscMessage read = tools::read_osc(osc_bytes("/haptel/a", "ifshTdF", values));
    CHECK(read.error.empty());
    CHECK(read.address == "/haptel/a");
    REQUIRE(read.values.size() == 7);
    CHECK(read.values[0] == OscValue(int32_t{-2}));
    CHECK(read.values[1] == OscValue(0.25f));
    CHECK(read.values[2] == OscValue(std::string("60um")));
    CHECK(read.values[3] == OscValue(int64_t{0x100000002}));
    CHECK(read.values[4] == OscValue(true));
    CHECK(read.values[5] == OscValue(0.5));
    CHECK(read.values[6] == OscValue(false));
    CHECK(tools::read_osc(osc_bytes("/stop")).values.empty());
    CHECK(tools::text_of(OscValue(0.00006f)) == "6e-05"); // not the sixteen digits of a double
    CHECK(tools::text_of(OscValue(5.0f)) == "5");
    CHECK(tools::text_of(OscValue(true)) == "true");
}

TEST_CASE("osc: messages are written to the bytes of the protocol")
{
    CHECK(tools::write_osc({"/haptel/ok", {std::string("abc"), int32_t{-2}, 0.25f, true}}) ==
          osc_bytes("/haptel/ok", "sifT", osc_text("abc") + osc_word(0xfffffffe) + osc_float(0.25f)));
    CHECK(tools::write_osc({"/a", {0.5}}) == osc_bytes("/a", "d", osc_word(0x3fe00000) + osc_word(0)));
    CHECK(tools::write_osc({"/abc", {}}) == osc_bytes("/abc"));
}

TEST_CASE("osc: a message that is cut anywhere, not padded, or of another kind is refused")
{
    const std::string whole = osc_bytes("/haptel/a", "sif", osc_text("60um") + osc_word(1) + osc_float(1));
    for (size_t size = 0; size < whole.size(); ++size) CHECK(!error_of(whole.substr(0, size)).empty());
    CHECK(error_of(whole).empty());
    CHECK(!error_of(whole + osc_word(0)).empty()); // more than its types say
    CHECK(!error_of(osc_text("/haptel/a")).empty());
    CHECK(!error_of("abcd" + whole).empty());
    CHECK(!error_of(osc_bytes("/a", "s", "abcd")).empty()); // no zero at the end
    CHECK(error_of(osc_bytes("/a", "b", osc_word(4) + "abcd")).find("the type 'b'") != std::string::npos);
    CHECK(!error_of(osc_bytes("/a", "b", osc_word(0x7ffffff0) + "abcd")).empty());
    CHECK(!error_of(osc_bytes("/a", "b", osc_word(0xffffffff) + "abcd")).empty());
    CHECK(!error_of(osc_bytes("/a", "\x7f")).empty());
    CHECK(!error_of(osc_bytes("/" + std::string(tools::osc_bytes_max, 'a'))).empty());
}

TEST_CASE("osc: bundles are taken apart in order, damaged ones and bombs are refused")
{
    const std::string a = osc_bytes("/a"), b = osc_bytes("/b"), c = osc_bytes("/c");
    CHECK(tools::split_osc(a).messages == std::vector<std::string_view>{a});
    const std::string nested = osc_bundle({a, osc_bundle({b}), c});
    CHECK(tools::split_osc(nested).messages == std::vector<std::string_view>{a, b, c});
    CHECK(tools::split_osc(osc_bundle({})).messages.empty());
    for (size_t size = 17; size < nested.size(); ++size) {
        const tools::OscParts parts = tools::split_osc(std::string_view(nested).substr(0, size));
        const bool is_whole = size == 16 + 4 + a.size() || size == nested.size() - c.size() - 4;
        CHECK(parts.error.empty() == is_whole);
    }
    CHECK(!tools::split_osc(osc_text("#bundle") + osc_word(0)).error.empty());
    CHECK(!tools::split_osc(osc_bundle({}) + osc_word(0xfffffffc) + a).error.empty());
    CHECK(!tools::split_osc(osc_bundle({}) + osc_word(0)).error.empty());
    std::string deep = a;
    while (deep.size() + 20 <= tools::osc_bytes_max) deep = osc_bundle({deep});
    CHECK(!tools::split_osc(deep).error.empty());
    CHECK(!tools::split_osc(std::string(tools::osc_bytes_max + 4, 'a')).error.empty());
    CHECK(!tools::split_osc(osc_bundle(std::vector<std::string>(300, a))).error.empty());
}
