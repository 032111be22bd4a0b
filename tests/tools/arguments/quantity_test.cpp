#include "tests/support/catch.h"
#include "tools/arguments/quantity.h"

#include <string>
#include <vector>

using namespace haptel::tools;

TEST_CASE("a length is the double nearest to its decimal value times its unit")
{
    CHECK(parse_length("20mm").value == 0.02);
    CHECK(parse_length("0.2m").value == 0.2);
    CHECK(parse_length("0.2").value == 0.2);
    CHECK(parse_length("60um").value == 60e-6);
    CHECK(parse_length("0.8mm").value == 0.0008); // 0.8 * 0.001 and 0.8 / 1000 are other doubles for some digits
    CHECK(parse_length("0.3mm").value == 0.0003);
    CHECK(parse_length("1.1nm").value == 1.1e-9);
    CHECK(parse_length("12.7cm").value == 0.127);
    CHECK(parse_length("1.5e1mm").value == 0.015);
    CHECK(parse_length("2E-3").value == 0.002);
    CHECK(parse_length("-3mm").value == -0.003);
    CHECK(parse_length("+3mm").value == 0.003);
    CHECK(parse_length(" 3 mm ").value == 0.003);
    CHECK(parse_length("7µm").value == 7e-6);
    CHECK(parse_length("7μm").value == 7e-6);
}

TEST_CASE("what is no length is refused with what was expected and what was found")
{
    for (const std::string text :
         {"", "mm", "x", "--2mm", "+-2mm", "++2mm", "nan", "inf", "-infinity", "1e999mm", "nanmm", "0x10"}) {
        CAPTURE(text);
        CHECK(!parse_length(text));
    }
    CHECK(parse_length("20xm").error.find("'xm'") != std::string::npos);
    CHECK(parse_length("20xm").error.find("mm, um or nm") != std::string::npos);
    CHECK(parse_length("20deg").error.find("unknown unit 'deg'") != std::string::npos);
    CHECK(parse_length("wide").error.find("such as 20mm") != std::string::npos);
    CHECK(!parse_length("1e99999999999999999999mm"));
    CHECK(!parse_length(std::string("2m\0", 3)));
    CHECK(!parse_length("2\xff"));
}

TEST_CASE("points and vectors are lists of exactly as many numbers")
{
    CHECK(parse_point("1mm,2cm,-0.5").value == glm::dvec3(0.001, 0.02, -0.5));
    CHECK(parse_point(" 1mm , 0 , 0 ").value == glm::dvec3(0.001, 0, 0));
    CHECK(parse_vector("0,0.6,0.8").value == glm::dvec3(0, 0.6, 0.8));
    CHECK(parse_vector2("0.25,1e-3").value == glm::dvec2(0.25, 0.001));
    CHECK(parse_vector("1,2").error.find("found 2 numbers") != std::string::npos);
    CHECK(parse_vector("1,2,3,4").error.find("found 4 numbers") != std::string::npos);
    CHECK(!parse_vector("1,2mm,3"));
    CHECK(!parse_vector(""));
    CHECK(!parse_vector(",,"));
    CHECK(!parse_point("1mm;2mm;3mm"));
}

TEST_CASE("a length option is misuse where its text is none or it is not positive")
{
    const auto parse = [](const std::string& text) {
        CLI::App app;
        double window_m = 0;
        add_length(app, "--window", window_m, "side");
        std::vector<std::string> arguments{text, "--window"}; // CLI11 takes them last first
        app.parse(arguments);
        return window_m;
    };
    CHECK(parse("20mm") == 0.02);
    CHECK_THROWS_AS(parse("twenty"), CLI::ParseError);
    CHECK_THROWS_AS(parse("0"), CLI::ParseError);
    CHECK_THROWS_AS(parse("nan"), CLI::ParseError);
}
