// HAPTEL_ISA: a smaller instruction set changes no bit, but where products are fused with sums, and what is not there
// is refused with what is.
#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"

#include <set>

using namespace haptel::test;

TEST_CASE("every instruction set gives the same bits in f64, and every one that fuses in every precision")
{
    const Folder folder;
    const std::string file =
        folder.write("all.haptel", "texture t() { return 1mm * (fbm(p / 10mm, 8) + noise(p / 1mm)\n"
                                   "  + fourier(p.xy / 1mm, 7) + white(p / 1mm, 0.5) + cellular(p / 3mm, 0.1)); }\n");
    std::string points = "x,y,z\n";
    for (int i = 0; i < 40; ++i)
        points += std::to_string(i * 0.00123) + "," + std::to_string(i * -17.00071) + ",0.00251\n";
    folder.write("points.csv", points);
    for (const std::string precision : {"f64", "mixed", "f32"}) {
        std::set<std::string> answers;
        size_t runs = 0;
        for (const std::string isa : {"baseline", "avx2", "avx512", "host"}) {
            const Ran ran = run_command("eval '" + file + ":t' --points '" + folder.file("points.csv") +
                                            "' --precision " + precision,
                                        "HAPTEL_ISA=" + isa);
            INFO(isa << ": " << ran.err);
            const bool is_there = !contains(ran.err, "which this machine has not");
            CHECK((ran.code == 0 || !is_there));
            const bool is_fused = isa != "baseline" && precision != "f64";
            if (is_there && (is_fused || precision == "f64")) answers.insert(ran.out);
            runs += is_there;
        }
        CHECK(runs >= 2); // baseline and host are everywhere
        CHECK(answers.size() == 1);
        CHECK(contains(*answers.begin(), "height_m"));
    }
}

TEST_CASE("an instruction set that is not known is an error that lists what this machine has")
{
    const Folder folder;
    const std::string file = folder.write("flat.haptel", "texture t() { return 1mm; }\n");
    const Ran ran = run_command("eval '" + file + ":t' --at 0,0,0", "HAPTEL_ISA=mmx");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "HAPTEL_ISA is 'mmx', which is no instruction set that Haptel knows: it has baseline, "));
    CHECK(contains(ran.err, ", host"));
}
