// haptel build --isa with several sets: which of them a processor runs, seen from outside of the program.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"

#include <nlohmann/json.hpp>
#include <sstream>

using namespace haptel::test;

namespace {

// Says how far the entry of the table is from main.
constexpr const char* distance_program = R"(#include "t.h"
#include <stdio.h>
int main(void)
{
    haptel_point point = {{1e-3}};
    haptel_block_t block = haptel_defaults_t;
    haptel_sample sample;
    haptel_texture_t.height_gradient(&point, &block, &sample);
    if (haptel_texture_t.facts.height_max_m < sample.height_m) return 1;
    printf("%ld\n", (long)((const char*)haptel_texture_t.height_gradient - (const char*)main));
    return 0;
}
)";

// The set of the function that is so far from main, by the program's symbols.
std::string set_at(const std::string& symbols, long distance)
{
    const auto place_of = [](const std::string& line) { return std::stol(line, nullptr, 16); };
    std::istringstream lines(symbols);
    std::string line;
    long main = 0;
    while (std::getline(lines, line))
        if (line.ends_with(" T main")) main = place_of(line);
    REQUIRE(main != 0);
    lines = std::istringstream(symbols);
    while (std::getline(lines, line))
        if (contains(line, " t ") && place_of(line) - main == distance) return line.substr(line.rfind('.') + 1);
    return "none";
}

struct Built {
    Folder folder;
    std::string file = folder.write("t.haptel", "texture t() { return 1mm * sinturn(p.x / 7mm); }\n");
    std::string at = "cd '" + folder.path.string() + "' && ";

    // As a library of these sets, within a program that is linked so.
    Built(const std::string& isas, const std::string& link)
    {
        folder.write("main.c", distance_program);
        REQUIRE(run_command("build '" + file + "' --emit header -o '" + folder.file("t.h") + "'").code == 0);
        const Ran ran =
            run_command("build '" + file + "' --emit static --isa " + isas + " -o '" + folder.file("libt.a") + "'");
        INFO(ran.err);
        REQUIRE(ran.code == 0);
        REQUIRE(shell(at + "cc -std=c99 " + link + " main.c libt.a -lm -o main && nm main >symbols") == 0);
    }

    bool runs() const { return shell(at + "./main >out") == 0; }

    // The set that this program runs, started by another: a simulated processor.
    std::string set(const std::string& before = "") const
    {
        REQUIRE(shell(at + before + " ./main >out") == 0);
        return set_at(read_file(folder.file("symbols")), std::stol(read_file(folder.file("out"))));
    }
};

bool is_x86()
{
#ifdef __x86_64__
    return true;
#else
    return false;
#endif
}

} // namespace

TEST_CASE("the largest set runs that the processor has, in programs of every kind")
{
    if (!is_x86()) return;
#ifdef __x86_64__
    const char* const largest = __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                                        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd")
                                    ? "avx512"
                                : __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? "avx2"
                                                                                                  : "baseline";
    for (const char* link : {"", "-static", "-static-pie -fPIE", "-no-pie"}) {
        CAPTURE(link);
        CHECK(Built("avx512,baseline,avx2", link).set() == largest);
        CHECK(Built("baseline", link).runs());
    }
#endif
}

TEST_CASE("a processor or a system without a part of a set runs a smaller one")
{
    if (!is_x86()) return;
    const std::string simulated = "qemu-x86_64-static";
    if (shell(simulated + " --version >/dev/null 2>&1") != 0) {
        WARN("not tried: install qemu-user-static to have simulated processors");
        return;
    }
    const Built all("baseline,avx2,avx512", "-static"), without_least("avx2,avx512", "-static");
    struct Processor {
        const char *name, *set;
    };
    for (const Processor& processor : {Processor{"qemu64", "baseline"},
                                       {"Nehalem", "baseline"},
                                       {"Haswell", "avx2"},
                                       {"Haswell,-fma", "baseline"},
                                       {"Haswell,-bmi2", "baseline"},
                                       {"Haswell,-abm", "baseline"},
                                       {"Haswell,-xsave", "baseline"}}) {
        CAPTURE(processor.name);
        CHECK(all.set(simulated + " -cpu " + processor.name + " 2>/dev/null") == processor.set);
    }
    CHECK(without_least.set(simulated + " -cpu Haswell 2>/dev/null") == "avx2");
}

TEST_CASE("several sets are said in JSON, and a list that is none is refused")
{
    if (!is_x86()) return;
    const Folder folder;
    const std::string file = folder.write("t.haptel", "texture t() { return 1mm; }\n");
    const auto build = [&](const std::string& isas) {
        return run_command("build --emit object --isa " + isas + " '" + file + "' --json -o '" + folder.file("t.o") +
                           "'");
    };
    CHECK(nlohmann::json::parse(build("avx2,baseline").out)["isa"] == nlohmann::json{"avx2", "baseline"});
    CHECK(nlohmann::json::parse(build("avx2").out)["isa"] == nlohmann::json{"avx2"});
    const Ran other = build("avx2,aarch64");
    CHECK(other.code == 2);
    CHECK(contains(other.err, "--isa: 'avx2' and 'aarch64' are of different architectures"));
    CHECK(build("avx2,avx2").code == 2);
    CHECK(build("avx2,mmx").code == 2);
}
