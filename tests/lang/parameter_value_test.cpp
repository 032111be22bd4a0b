// What scenes and command lines set: numbers with units, names of choices.
#include "lang/compile.h"
#include "lang/parameter_value.h"

#include "tests/support/catch.h"

using namespace haptel;
using namespace haptel::lang;

namespace {

const char* const wall =
    "texture wall(int bond = running in {running, english, stack}, float depth = 1mm in 0mm .. 2mm) "
    "{ return bond * depth; }";

class Wall {
public:
    Wall() : result(compile({"wall.haptel", wall}, {})) { REQUIRE(result.program); }
    const ir::Texture& texture() const { return result.program->module.textures[0]; }
    // "bond = 1"; what is wrong, with its hint.
    std::string said(std::string_view name, std::string_view text) const
    {
        for (const ir::Parameter& parameter : texture().parameters) {
            if (parameter.name != name) continue;
            const ParameterValue read = parse_value(text, parameter);
            if (!read.error.empty()) return read.error + (read.hint.empty() ? "" : " | " + read.hint);
            return parameter.name + " = " + std::to_string(read.value);
        }
        return "nothing has this name";
    }

private:
    CompileResult result;
};

} // namespace

TEST_CASE("parameter value: choices by their names and by their numbers")
{
    const Wall wall;
    CHECK(wall.texture().parameters[0].choices == std::vector<std::string>{"running", "english", "stack"});
    CHECK(wall.texture().parameters[1].choices.empty());
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
