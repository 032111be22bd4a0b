// What the resolver gives for a request, and why it gives nothing.
#include "jit/texture/resolver.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/folder.h"

using namespace haptel;
using test::contains;
using test::request_over;
using test::sample_at;

TEST_CASE("a texture too slow for the servo of its request is refused with the figure, from its first binding on")
{
    const test::Folder folder;
    folder.write("slow.haptel", "texture slow() { float h = 0.0; for (int i = 0; i < 100; ++i)"
                                " h += sin(p.x / 1mm + float(i)); return clamp(1um * h, -1mm, 1mm); }");
    const TextureResolver resolve = jit::make_resolver(std::make_shared<jit::ProgramCache>());
    TextureRequest request = request_over(0.05);
    request.reference = folder.file("slow.haptel:slow");
    CHECK(resolve(request).binding); // no servo waits
    request.servo_period_s = 1;
    CHECK(resolve(request).binding);
    request.servo_period_s = 1e-7; // 100 sines and cosines in 0.02 us
    const TextureResult refused = resolve(request);
    CHECK_FALSE(refused.binding);
    INFO(refused.diagnostics);
    CHECK(contains(refused.diagnostics, "slow.haptel: error: texture 'slow' takes "));
    CHECK(contains(refused.diagnostics, "per call (median), more than the 0.02 us that a servo period of 0.1 us"));
}

TEST_CASE("the resolver finds textures by reference, and explains what it does not find")
{
    const test::Folder folder;
    folder.write("rock.haptel", "texture rock(float depth = 60um) { return depth; }");
    folder.write("two.haptel",
                 "import \"parts.haptel\"; texture a() { return halve(2mm); } texture b() { return 1mm; }");
    folder.write("parts.haptel", "float halve(float x) { return x / 2.0; }");
    folder.write("broken.haptel", "texture t() { return ; }");
    const TextureResolver resolve = jit::make_resolver(std::make_shared<jit::ProgramCache>());
    const auto ask = [&](const std::string& reference) {
        TextureRequest request = request_over(0.05);
        request.reference = folder.file(reference);
        return resolve(request);
    };
    const auto height = [&](const std::string& reference) {
        const TextureResult result = ask(reference);
        INFO(result.diagnostics);
        REQUIRE(result.binding);
        return sample_at(*result.binding, {0, 0, 0}).height_m;
    };
    const TextureResult rock = ask("rock.haptel:rock"), rock_again = ask("rock.haptel");
    REQUIRE((rock.binding && rock_again.binding));
    CHECK(rock.binding->texture == rock_again.binding->texture); // compiled once
    CHECK(sample_at(*rock.binding, {0, 0, 0}).height_m == 60e-6);
    CHECK(height("two.haptel:a") == 1e-3);

    const std::vector<std::pair<const char*, const char*>> table = {
        {"two.haptel", "it has a, b: write FILE:NAME"},
        {"two.haptel:c", "this file has no texture 'c'\n  hint: it has the textures a, b\n"},
        {"parts.haptel:c", "this file has no texture 'c'\n  hint: it has none\n"},
        {"rok.haptel:rock", "did you mean 'rock.haptel'?"},
        {"broken.haptel:t", "broken.haptel:1:"},
        {"", "it is a folder"},
    };
    for (const auto& [reference, message] : table) {
        const TextureResult result = ask(reference);
        INFO(reference << "\n" << result.diagnostics);
        CHECK_FALSE(result.binding);
        CHECK(contains(result.diagnostics, message));
    }

    TextureRequest wrong = request_over(0.05);
    wrong.reference = folder.file("rock.haptel:rock");
    wrong.parameters = {{"dept", "1mm"}, {"depth", "1kg"}};
    const std::string file = folder.file("rock.haptel");
    CHECK(resolve(wrong).diagnostics ==
          file + ": error: texture 'rock' has no parameter 'dept'\n  hint: did you mean 'depth'?\n" + file +
              ": error: parameter 'depth' of texture 'rock': unknown unit 'kg'\n  hint: units are m, cm, mm, um, nm, "
              "deg, "
              "rad, s, ms, Hz and kHz\n");

    folder.write("parts.haptel", "float halve(float x) { return x / 4.0; }"); // an import changes the program too
    CHECK(height("two.haptel:a") == 0.5e-3);
}
