// What the checker says, word for word and to the column.
#include "tests/lang/golden.h"
#include "tests/support/catch.h"

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace haptel::lang::test;

TEST_CASE("check: golden files")
{
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(HAPTEL_SOURCE_DIR "/tests/lang/golden")) {
        std::ifstream file(entry.path(), std::ios::binary);
        std::stringstream text;
        text << file.rdbuf();
        INFO(entry.path().filename().string());
        CHECK(golden_differences(text.str()) == "");
        ++files;
    }
    CHECK(files >= 10);
}

TEST_CASE("golden: a wrong, a missing and an unexpected finding are all noticed")
{
    const std::string right = "float f(bool b) { return b; } //! 26 error: expected float from 'f', found bool "
                              "[type-mismatch] = write float(b)\n";
    CHECK(golden_differences(right) == "");

    std::string wrong_column = right, wrong_hint = right;
    wrong_column.replace(wrong_column.find("26"), 2, "27");
    wrong_hint.replace(wrong_hint.find("write float(b)"), 14, "write float(c)");
    const std::string both =
        "unexpected: 1:26 error: expected float from 'f', found bool [type-mismatch] = write float(b)\n";
    CHECK(golden_differences(wrong_column) == both + "missing: 1:27 error: expected float from 'f', found bool "
                                                     "[type-mismatch] = write float(b)\n");
    CHECK(golden_differences(wrong_hint) == both + "missing: 1:26 error: expected float from 'f', found bool "
                                                   "[type-mismatch] = write float(c)\n");
    CHECK(golden_differences("float f(bool b) { return b; }\n") == both);
    CHECK(golden_differences("texture t() { return 0.0; } //! 1 error: nothing [none]\n") ==
          "missing: 1:1 error: nothing [none] = \n");
}
