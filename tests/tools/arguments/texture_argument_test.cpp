#include "tests/support/catch.h"
#include "tools/arguments/texture_argument.h"

using namespace haptel::tools;

namespace {

struct Line {
    TextureArgument texture;
    ParameterTexts parameters;
    bool flag = false;

    explicit Line(std::vector<std::string> words)
    {
        CLI::App app;
        add_texture(app, texture);
        add_parameters(app, parameters);
        app.add_flag("--flag", flag);
        std::reverse(words.begin(), words.end()); // CLI11 takes them last first
        app.parse(words);
    }
};

} // namespace

TEST_CASE("a texture is named by its file and its name, at the last colon")
{
    CHECK(Line({"a/rock.haptel:rock"}).texture.file == "a/rock.haptel");
    CHECK(Line({"C:rock.haptel:rock"}).texture.file == "C:rock.haptel");
    CHECK(Line({"a/rock.haptel:rock"}).texture.name == "rock");
    for (const std::string bad : {"rock.haptel", "rock.haptel:", ":rock", ":"})
        CHECK_THROWS_AS(Line({bad}), CLI::ParseError);
}

TEST_CASE("parameters are names and values as written, before and after the texture")
{
    const Line line({"--set", "depth=60um", "f.haptel:f", "--set", "expression=a=b", "--flag", "--set", "n=5"});
    CHECK(line.texture.name == "f");
    CHECK(line.flag);
    CHECK(line.parameters == ParameterTexts{{"depth", "60um"}, {"expression", "a=b"}, {"n", "5"}});
    for (const std::string bad : {"depth", "=5", "depth="})
        CHECK_THROWS_AS(Line({"f:f", "--set", bad}), CLI::ParseError);
}
