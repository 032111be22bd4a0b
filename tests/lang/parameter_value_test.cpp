// What scenes and command lines set: numbers with units, names of choices, components of vectors.
#include "lang/compile.h"
#include "lang/parameter_value.h"

#include "tests/support/catch.h"

using namespace haptel;
using namespace haptel::lang;

namespace {

const char* const wall =
    "texture wall(int bond = running in {running, english, stack}, vec2 size = vec2(21cm, 7cm) in 1cm "
    ".. 50cm, float depth = 1mm in 0mm .. 2mm) { return bond * depth * (size.x / size.y); }";

class Wall {
public:
    Wall() : result(compile({"wall.haptel", wall}, {})) { REQUIRE(result.program); }
    const ir::Texture& texture() const { return result.program->module.textures[0]; }
    ParameterValues set(std::string_view name, std::string_view text) const
    {
        return parse_values(name, text, texture());
    }
    // "bond = 1"; what is wrong, with its hint.
    std::string said(std::string_view name, std::string_view text) const
    {
        const ParameterValues read = set(name, text);
        std::string all;
        for (size_t i = 0; i < read.values.size(); ++i) {
            const ParameterValue& value = read.values[i];
            if (!value.error.empty()) return value.error + (value.hint.empty() ? "" : " | " + value.hint);
            all += (i > 0 ? ", " : "") + read.parameters[i].name + " = " + std::to_string(value.value) + value.warning;
        }
        return all.empty() ? "nothing has this name" : all;
    }

private:
    CompileResult result;
};

} // namespace

TEST_CASE("parameter value: choices by their names and by their numbers")
{
    const Wall wall;
    CHECK(wall.texture().parameters[0].choices == std::vector<std::string>{"running", "english", "stack"});
    CHECK(wall.texture().parameters[3].choices.empty());
    CHECK(wall.said("bond", "english") == "bond = 1.000000");
    CHECK(wall.said("bond", " stack\t") == "bond = 2.000000");
    CHECK(wall.said("bond", "2") == "bond = 2.000000");
    CHECK(wall.said("bond", "englsh") ==
          "expected running, english or stack, found 'englsh' | did you mean 'english'?");
    CHECK(wall.said("bond", "flemish") == "expected running, english or stack, found 'flemish'");
    CHECK(wall.said("bond", "English") ==
          "expected running, english or stack, found 'English' | did you mean 'english'?");
    CHECK(wall.said("bond", "3") == "3 is outside its range: expected a whole number in 0 .. 2");
    CHECK(wall.said("bond", "-1") == "-1 is outside its range: expected a whole number in 0 .. 2");
    CHECK(wall.said("bond", "") == "expected running, english or stack, found ''");
    CHECK(wall.said("depth", "english") == "expected a number, found 'english'");
}

TEST_CASE("parameter value: a vector as a whole and by its components")
{
    const Wall wall;
    CHECK(wall.said("size", "20cm, 5cm") == "size.x = 0.200000, size.y = 0.050000");
    CHECK(wall.said("size", "0.25,50 mm") == "size.x = 0.250000, size.y = 0.050000");
    CHECK(wall.said("size.y", "5cm") == "size.y = 0.050000");
    CHECK(wall.said("size", "20cm") == "expected 2 numbers, found '20cm' | write them with commas between: 0.21, 0.07");
    CHECK(wall.said("size", "1cm, 2cm, 3cm") ==
          "expected 2 numbers, found '1cm, 2cm, 3cm' | write them with commas between: 0.21, 0.07");
    CHECK(wall.said("size", "1cm, 2s") == "expected a length such as 0.5mm or 60um, found '2s'");
    CHECK(wall.said("size", "1cm, 60cm") ==
          "size.x = 0.010000, size.y = 0.60000060cm is outside of its range 0.01 .. 0.5 m");
    CHECK(wall.said("size.z", "5cm") == "nothing has this name");
    CHECK(wall.said("siz", "5cm, 5cm") == "nothing has this name");
    CHECK(wall.said("size.", "5cm") == "nothing has this name");
    CHECK(parameter_names(wall.texture()) == std::vector<std::string>{"bond", "size", "size.x", "size.y", "depth"});
    // Where they are set: one behind the other.
    CHECK(wall.set("size", "1cm, 2cm").parameters.data() == &wall.texture().parameters[1]);
    CHECK(wall.set("size.y", "1cm").parameters.data() == &wall.texture().parameters[2]);
}

TEST_CASE("compile: the components of a vector are parameters of their own")
{
    const Wall wall;
    const std::vector<ir::Parameter>& parameters = wall.texture().parameters;
    REQUIRE(parameters.size() == 4);
    const double values[] = {0.21, 0.07};
    for (size_t i = 0; i < 2; ++i) {
        CHECK(parameters[1 + i].unit == "m");
        CHECK(parameters[1 + i].type == ir::Type::real);
        CHECK(parameters[1 + i].value == values[i]);
        CHECK(parameters[1 + i].minimum == 0.01);
        CHECK(parameters[1 + i].maximum == 0.5);
    }
    CHECK(parameters[0].minimum == 0);
    CHECK(parameters[0].maximum == 2);
    CHECK(parameters[2].offset == parameters[1].offset + 8);
    CHECK(parameters[3].offset == parameters[1].offset + 16);
}
