// docs/language.md and docs/porting.md: every example compiles without a finding, or with those that its fence names,
// and gives the values that stand in it.
#include "tests/conformance/case.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <fmt/format.h>
#include <set>
#include <sstream>

using namespace haptel::test;
using haptel::lang::test::Case;
using haptel::lang::test::Evaluation;
using haptel::tools::Json;

namespace {

struct Fence {
    size_t line = 0;
    std::string info, text; // info: what stands behind "```"
};

std::vector<Fence> fences(const std::string& name)
{
    std::istringstream page(read_file(project_path("docs/" + name)));
    std::vector<Fence> all;
    bool inside = false;
    size_t number = 0;
    for (std::string line; std::getline(page, line);) {
        ++number;
        const bool is_fence = line.rfind("```", 0) == 0;
        if (is_fence && !inside) all.push_back({number, line.substr(3), {}});
        if (!is_fence && inside) all.back().text += line + "\n";
        if (is_fence) inside = !inside;
    }
    return all;
}

std::set<std::string> words_of(const std::string& text)
{
    std::istringstream stream(text);
    std::set<std::string> words;
    for (std::string word; stream >> word;) words.insert(word);
    return words;
}

// By the compiled code, through the command.
void check_value(const std::string& file, const std::string& texture, const Evaluation& wanted)
{
    INFO(wanted.line);
    const haptel_point& at = wanted.point;
    std::string arguments =
        fmt::format("eval '{}:{}' --json --at {},{},{} --normal {},{},{} --velocity {},{},{} "
                    "--normal-force {} --tool-radius {}",
                    file, texture, at.p[0], at.p[1], at.p[2], at.n[0], at.n[1], at.n[2], at.velocity[0], at.velocity[1],
                    at.velocity[2], at.normal_force_n, at.tool_radius_m);
    for (const auto& [name, value] : wanted.parameters) arguments += " --set " + name + "=" + value;
    const Ran ran = run_command(arguments);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const Json json = Json::parse(ran.out);
    haptel::lang::test::Outcome found;
    found.height = json["height_m"];
    found.gradient = json["gradient"].get<std::array<double, 3>>();
    found.faults = json["faults"];
    for (const auto& [name, components] : wanted.outputs)
        if (const haptel::OutputInfo* const output = haptel::find_output(name);
            output && json.contains(name) && components.size() == 1)
            haptel::components_of(found.sample, *output)[0] = json[name];
    CHECK(value_differences(wanted, "compiled", found) == "");
}

} // namespace

TEST_CASE("language page, porting page: every example does what it says")
{
    const Folder folder;
    size_t examples = 0, values = 0;
    const std::string page = GENERATE("language.md", "porting.md");
    for (const Fence& fence : fences(page)) {
        std::set<std::string> wanted = words_of(fence.info);
        if (wanted.erase("glsl") == 0) continue;
        INFO("docs/" << page << ":" << fence.line);
        std::string name = fmt::format("example{}.haptel", examples++);
        if (wanted.erase("file") > 0) {
            REQUIRE(wanted.size() == 1);
            name = *wanted.begin();
            wanted.clear();
            std::filesystem::create_directories(std::filesystem::path(folder.file(name)).parent_path());
        }
        const std::string file = folder.write(name, fence.text);
        if (is_sanitized && examples % 4 != 0) continue; // commands for each example take long then
        std::set<std::string> found;
        const Ran ran = run_command("check --json '" + file + "'");
        INFO(ran.err);
        const Json checked = Json::parse(ran.out);
        for (const Json& finding : checked["diagnostics"]) found.insert(finding["code"].get<std::string>());
        if (wanted.count("empty-file") == 0) found.erase("empty-file"); // functions alone are examples too
        CHECK(found == wanted);
        const Case parsed = haptel::lang::test::read_case(fence.text);
        CHECK(parsed.malformed == "");
        for (const Evaluation& evaluation : parsed.evaluations) {
            REQUIRE(!checked["textures"].empty());
            check_value(file, checked["textures"].back()["name"], evaluation);
            ++values;
        }
    }
    const bool is_language = page == "language.md";
    CHECK(examples > (is_language ? 35u : 2u));
    if (is_language) CHECK(values > tries(10u));
}
